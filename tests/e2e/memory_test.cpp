// The memory of the program: it does not grow with the length of a run, and the kernel may use large pages.
#include <sys/resource.h>

#include <fstream>
#include <string>

#include "tests/e2e/child.h"
#include "tests/e2e/program.h"

using namespace faba;

namespace {

// Largest peak memory of the processes so far, KiB.
long peak_kib() {
  rusage usage{};
  getrusage(RUSAGE_CHILDREN, &usage);
  return usage.ru_maxrss;
}

// Whether the process has asked for large pages in its heap; other regions are those of libraries.
bool large_pages(pid_t process) {
  std::ifstream regions("/proc/" + std::to_string(process) + "/smaps");
  bool heap = false;
  for (std::string line; std::getline(regions, line);) {
    if (line.find('-') < line.find(':')) heap = line.ends_with("[heap]");  // the first line of a region
    if (heap && line.starts_with("VmFlags:") && line.find(" hg") != std::string::npos) return true;
  }
  return false;
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

TEST_CASE("memory: a run of a million cells asks the kernel for large pages") {
  if (!std::filesystem::exists("/sys/kernel/mm/transparent_hugepage")) {
    MESSAGE("SKIPPED: this kernel has no large pages");
    return;
  }
  const TestFolder f;
  // Without a video, whose encoder asks for large pages itself.
  const Child run(f.path, FABA_PROGRAM
                  " run '" FABA_SCENES
                  "/million.toml' --seed 1 --quiet --set record.video=false --out run > /dev/null 2>&1");
  CHECK(soon([&] { return large_pages(run.process()) || run.ended(); }));
  CHECK(!run.ended());
}
