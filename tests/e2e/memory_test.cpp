// The memory of the program does not grow with the length of a run.
#include <sys/resource.h>

#include "tests/e2e/program.h"

using namespace faba;

namespace {

// Largest peak memory of the processes so far, KiB.
long peak_kib() {
  rusage usage{};
  getrusage(RUSAGE_CHILDREN, &usage);
  return usage.ru_maxrss;
}

}  // namespace

TEST_CASE("memory: ten times the frames of a run with videos and tracks need at most 1.1 times the memory") {
  const TestFolder f;
  const auto run = [&](const char* duration) {
    const Called c =
        faba_in(f.path, std::string("run '" FABA_SCENES "/as-seen.toml' --seed 1 --quiet --force --out run "
                                    "--set record.lossless=true --threads 2 --duration ") +
                            duration);
    REQUIRE_MESSAGE(c.exit == 0, c.err);
    return peak_kib();
  };
  const long earlier = peak_kib();
  // The short run fills the queues of frames and a row of chunks of the tracks.
  const long first = run("4"), second = run("40");
  REQUIRE_MESSAGE(first > earlier, "an earlier process took more memory; run this file alone");
  MESSAGE("peak memory MiB: ", first / 1024, " for 4 s, ", second / 1024, " for 40 s");
  CHECK(double(second) <= 1.1 * double(first));
}
