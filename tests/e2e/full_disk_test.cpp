// What a run does when the disk is full. Skipped where no small file system can be mounted.
#include <doctest/doctest.h>
#include <unistd.h>

#include "tests/e2e/program.h"
#include "tests/skip.h"

using namespace faba;

TEST_CASE("a full disk: exit 1, one line, the run stays marked incomplete") {
  const TestFolder f;
  const auto disk = f.path / "disk";
  std::filesystem::create_directory(disk);
  const std::string mount = "mount -t tmpfs -o size=1m tmpfs '" + disk.string() + "' 2> /dev/null";
  if (geteuid() != 0 || std::system(mount.c_str()) != 0) {
    test::skip("no small file system can be mounted here");
    return;
  }
  for (const char* record :
       {"video = false\ncompress = false", "tracks = false", "video = false\ntracks = false"}) {
    INFO(record);
    write_file(f.path / "s.toml", "duration = '400 s'\n[[swarm]]\ncount = 500\nmodel = 'basic'\n[record]\n" +
                                      std::string(record) + "\ncheckpoint = '0.2 s'\n");
    const Called c = faba_in(f.path, "run s.toml --seed 1 --force --quiet --out disk/run");
    INFO(c.err);
    CHECK(c.exit == 1);
    CHECK(one_clear_line(c.err));
    CHECK(c.err.find("No space left") != std::string::npos);
    CHECK(std::filesystem::exists(disk / "run/incomplete"));
    CHECK_FALSE(std::filesystem::exists(disk / "run/report.html"));
    std::filesystem::remove_all(disk / "run");
  }
  CHECK(std::system(("umount '" + disk.string() + "'").c_str()) == 0);
}
