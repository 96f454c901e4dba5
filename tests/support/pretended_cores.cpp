// Preloaded into the program (LD_PRELOAD), tells it that the machine has as many cores as PRETENDED_CORES says.
#include <cstdlib>

/// What std::thread::hardware_concurrency() asks.
extern "C" int get_nprocs() {
  return std::atoi(std::getenv("PRETENDED_CORES"));
}
