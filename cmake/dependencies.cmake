# Every library comes from Debian 12 (tools/packages.txt); nothing is downloaded by the build.

find_package(OpenCV 4.6 REQUIRED COMPONENTS core imgproc calib3d imgcodecs videoio video tracking photo aruco objdetect)
find_package(Eigen3 3.4 REQUIRED NO_MODULE)
find_package(fmt REQUIRED)
find_package(spdlog REQUIRED)
find_package(CLI11 REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(tl-expected REQUIRED)
find_package(tomlplusplus REQUIRED)
find_package(yaml-cpp 0.7 REQUIRED)
find_package(OpenSSL REQUIRED)
find_package(Threads REQUIRED)
find_package(GTest REQUIRED)
find_package(benchmark REQUIRED)
find_package(PkgConfig REQUIRED)
pkg_check_modules(SYSTEMD REQUIRED IMPORTED_TARGET libsystemd)
pkg_check_modules(LZ4 REQUIRED IMPORTED_TARGET liblz4)  # recordings: chunks
find_package(ZLIB REQUIRED)                             # recordings: CRC-32
find_package(fastcdr REQUIRED)                          # recordings: ROS 2's serialization of images
pkg_check_modules(OSMESA REQUIRED IMPORTED_TARGET osmesa)  # OpenGL without a window
find_package(embree 3.13 REQUIRED)  # the simulator alone: ray tracing
find_package(assimp 5.2 REQUIRED)   # meshes: maps, and scenes of the simulator
find_package(Ceres 2.1 REQUIRED)     # a map refined from a drive (pipeline/mapping): in no program of the robot's
# The lab alone, and it works without: a peer that localisation is compared with. Its parts come without a package for CMake.
find_path(VISP_INCLUDE visp3/mbt/vpMbGenericTracker.h)
find_library(VISP_MBT visp_mbt)
find_library(VISP_ME visp_me)
find_library(VISP_CORE visp_core)
