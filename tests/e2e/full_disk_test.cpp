// Runs with a full disk. Skipped if no small file system can be mounted.
#include <doctest/doctest.h>
#include <unistd.h>

#include "tests/e2e/incomplete_run.h"
#include "tests/e2e/playback_scene.h"
#include "tests/skip.h"

using namespace faba;

TEST_CASE("a disk that becomes full at any time: the run is complete or marked incomplete") {
  const TestFolder f;
  const auto disk = f.path / "disk";
  std::filesystem::create_directory(disk);
  const std::string umount = "umount '" + disk.string() + "'";
  write_file(f.path / "s.toml", kSmallScene + "[record]\nlossless = true\ncheckpoint = '0.1 s'\n");
  int complete = 0;
  for (int kib = 4; complete == 0 && kib < 8192; kib += 4 + kib / 6) {
    const std::string size = std::to_string(kib) + "k";
    if (geteuid() != 0 ||
        std::system(
            ("mount -t tmpfs -o size=" + size + " tmpfs '" + disk.string() + "' 2> /dev/null").c_str()) !=
            0) {
      test::skip("mounting a small file system is not permitted");
      return;
    }
    const Called c = faba_in(f.path, "run s.toml --seed 1 --quiet --out disk/run");
    INFO(size);
    complete_or_marked(disk / "run", c);
    complete += c.exit == 0;
    CHECK(std::system(umount.c_str()) == 0);
  }
  CHECK(complete == 1);
}

TEST_CASE("a full disk: exit 1, one line, the run is marked incomplete") {
  const TestFolder f;
  const auto disk = f.path / "disk";
  std::filesystem::create_directory(disk);
  const std::string mount = "mount -t tmpfs -o size=1m tmpfs '" + disk.string() + "' 2> /dev/null";
  if (geteuid() != 0 || std::system(mount.c_str()) != 0) {
    test::skip("mounting a small file system is not permitted");
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

TEST_CASE(
    "a capture to a full disk: exit 1, one line, the recorded pictures are kept and marked incomplete") {
  const TestFolder f;
  const auto disk = f.path / "disk";
  std::filesystem::create_directory(disk);
  const std::string mount = "mount -t tmpfs -o size=64k tmpfs '" + disk.string() + "' 2> /dev/null";
  if (geteuid() != 0 || std::system(mount.c_str()) != 0) {
    test::skip("mounting a small file system is not permitted");
    return;
  }
  write_playback_scene(f.path, 60);
  for (const std::string out : {"disk/pictures --format pgm", "disk/a.avi"}) {
    INFO(out);
    const Called c = faba_in(f.path, "rig capture bench.toml --frames 60 --quiet --out " + out);
    INFO(c.err);
    CHECK(c.exit == 1);
    CHECK(one_clear_line(c.err));
    CHECK(c.err.find("No space left") != std::string::npos);
    CHECK(c.err.find("recorded frames are in disk/") != std::string::npos);
    if (out.ends_with("pgm")) {
      CHECK(std::filesystem::exists(disk / "pictures/incomplete"));
      CHECK(std::filesystem::exists(disk / "pictures/frame-000000.pgm"));
    } else {
      CHECK(std::filesystem::exists(disk / "a.avi.part"));
      CHECK_FALSE(std::filesystem::exists(disk / "a.avi"));
    }
    std::filesystem::remove_all(disk / "pictures");
  }
  CHECK(std::system(("umount '" + disk.string() + "'").c_str()) == 0);
}
