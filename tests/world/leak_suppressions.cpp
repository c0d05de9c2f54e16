// What the leak checker may overlook in this test program, compiled in so that nobody has to set an environment variable.

extern "C" const char* __lsan_default_suppressions();  // NOLINT(bugprone-reserved-identifier): the sanitizer's name

// assimp keeps what it had read of a damaged file when its importer throws.
extern "C" const char* __lsan_default_suppressions() {
  return "leak:libassimp.so\n";
}
