# One instruction set, one set of warnings, one choice of sanitizer for the whole build: every target inherits them from here.

set(CGSR_ARCH "x86-64" CACHE STRING "value of -march for our own code (x86-64 is the SSE2 baseline)")
set(CGSR_SANITIZE "" CACHE STRING "empty, or a value for -fsanitize (address,undefined or thread)")

# Never contract a*b+c: the same bytes on every machine matter more than the last percent.
add_compile_options(-march=${CGSR_ARCH} -ffp-contract=off)
# Eigen's square root of four floats would begin with RSQRTPS, whose last bits are each manufacturer's own.
add_compile_definitions(EIGEN_FAST_MATH=0)
add_compile_options(-Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor -Woverloaded-virtual -Wcast-align -Wold-style-cast
                    -Werror)
if(CGSR_SANITIZE)
  add_compile_options(-fsanitize=${CGSR_SANITIZE} -fno-sanitize-recover=all -fno-omit-frame-pointer)
  add_link_options(-fsanitize=${CGSR_SANITIZE})
  if(CGSR_SANITIZE MATCHES address)
    add_compile_options(-Wno-maybe-uninitialized)  # g++ 12 takes its own poisoning of std::function for one; the release build warns
  endif()
endif()

# Only for libFuzzer's programs (tools/fuzz): every branch is counted. The compiler is another one there, whose warnings are not those that are held.
option(CGSR_FUZZ "build the programs of tests/fuzz; the compiler is clang" OFF)
if(CGSR_FUZZ)
  add_compile_options(-fsanitize=fuzzer-no-link -Wno-error -Wno-unknown-warning-option)
endif()

# mold links in a tenth of the time; whoever has it not gets the system's linker. Before 2.4 it may end a page with thread-local variables and begin the
# next with what is made read-only after relocation; the loader then refuses the program ("cannot apply additional memory protection", by a
# chance of 7 in 4096 for each link, rui314/mold#1151). Variables that are aligned to 64 bytes cannot lie so; tests/tools/relro_test.py looks.
find_program(CGSR_MOLD mold)
if(CGSR_MOLD)
  add_link_options(-fuse-ld=mold)
endif()
