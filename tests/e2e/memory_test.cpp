// The memory of the program: it does not grow with the length of a run, and the kernel may use large pages.
#include <sys/resource.h>

#include <fstream>
#include <string>

#include "tests/e2e/child.h"
#include "tests/e2e/program.h"
#include "tests/skip.h"

using namespace faba;

namespace {

// Largest peak memory of the processes so far, KiB.
long peak_kib() {
  rusage usage{};
  getrusage(RUSAGE_CHILDREN, &usage);
  return usage.ru_maxrss;
}

// Size of the part of the heap for which the process has asked for large pages, MiB; other regions are those
// of libraries.
long large_pages_mib(pid_t process) {
  std::ifstream regions("/proc/" + std::to_string(process) + "/smaps");
  bool heap = false;
  long kib = 0, region_kib = 0;
  for (std::string line; std::getline(regions, line);) {
    if (line.find('-') < line.find(':')) heap = line.ends_with("[heap]");  // the first line of a region
    if (line.starts_with("Size:")) region_kib = std::stol(line.substr(5));
    if (heap && line.starts_with("VmFlags:") && line.find(" hg") != std::string::npos) kib += region_kib;
  }
  return kib / 1024;
}

// Whether a run of a scene asks for more than `mib` of large pages before it ends. Without a video, whose
// encoder asks for large pages itself.
bool asks_for_more_than(long mib, const std::string& scene, const std::string& duration) {
  const TestFolder f;
  const Child run(f.path, FABA_PROGRAM " run '" FABA_SCENES "/" + scene + ".toml' --duration " + duration +
                              " --seed 1 --quiet --set record.video=false --out run > /dev/null 2>&1");
  bool asked = false;
  CHECK(soon([&] { return (asked = large_pages_mib(run.process()) > mib) || run.ended(); }));
  return asked;
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

TEST_CASE(
    "memory: a run asks the kernel for large pages from the beginning, and whenever its heap has grown") {
  if (!std::filesystem::exists("/sys/kernel/mm/transparent_hugepage")) {
    test::skip("this kernel has no large pages");
    return;
  }
  CHECK(asks_for_more_than(0, "thesis-basic", "600"));
  CHECK(asks_for_more_than(128, "million", "60"));  // the heap grows in steps of 64 MiB
}
