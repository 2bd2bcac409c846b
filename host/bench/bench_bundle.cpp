// bench_bundle FILE: what the emulated processors need to run every method of the benchmark.
#include <cstdio>

#include "host/base/failure.hpp"
#include "host/bench/make_bundle.hpp"

int main(int count, char** arguments) try {
  if (count != 2) {
    std::fputs("usage: bench_bundle FILE\n", stderr);
    return static_cast<int>(strainfinger::ExitCode::kUsage);
  }
  strainfinger::bench::writeBundle(*strainfinger::bench::makeBundle({}), arguments[1]);
  return 0;
} catch (const strainfinger::Failure& failure) {
  std::fprintf(stderr, "bench_bundle: %s\n", failure.what());
  return static_cast<int>(failure.code());
}
