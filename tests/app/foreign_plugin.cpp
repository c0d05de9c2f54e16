// A shared library that is no simulator, for sim_run_test.
extern "C" int something_else() {
  return 1;
}
