// What the thread sanitizer may overlook in this test program, compiled in so that nobody has to set an environment variable.

extern "C" const char* __tsan_default_suppressions();  // NOLINT(bugprone-reserved-identifier): the sanitizer's name

// OpenCV's image files initialise GDAL, which takes two of its own locks in either order. OpenCV's player, the judge of what is
// written here, decodes with threads inside libavcodec, which the sanitizer cannot follow.
extern "C" const char* __tsan_default_suppressions() {
  return "deadlock:libgdal.so\n"
         "race:libavcodec.so\n"
         "race:libavutil.so\n";
}
