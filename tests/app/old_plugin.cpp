// A simulator of long ago, for sim_run_test.
extern "C" int cgsr_simulation_version() {
  return 0;
}
extern "C" void* cgsr_make_simulation(const void* /*parameters*/, void* /*error*/) {
  return nullptr;
}
