// A limit on file sizes: a run is complete, or it ends with an error that names the file and is marked
// incomplete.
#include <doctest/doctest.h>

#include <sys/wait.h>

#include "tests/e2e/incomplete_run.h"

using namespace faba;

namespace {

// One run with files of at most `blocks` of 512 bytes. The message comes through a pipe, because a file would
// have the same limit.
Called run_limited(const std::filesystem::path& folder, int blocks) {
  const std::string command = "cd '" + folder.string() + "' && rm -rf run && ulimit -f " +
                              std::to_string(blocks) +
                              " && exec '" FABA_PROGRAM "' run s.toml --seed 1 --quiet --out run 2>&1";
  Called c;
  FILE* pipe = popen(command.c_str(), "r");
  char buffer[4096];
  for (std::size_t n; (n = std::fread(buffer, 1, sizeof buffer, pipe)) > 0;) c.err.append(buffer, n);
  const int status = pclose(pipe);
  c.exit = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  return c;
}

}  // namespace

TEST_CASE("file size limit: every recorder reports the file, and the run is marked incomplete") {
  struct Recorder {
    const char* record;  ///< keys of [record]
    const char* file;    ///< the file that an error must name for at least one limit
  };
  // Checkpoints in every frame, so that each recorder is flushed often.
  for (const Recorder& r :
       {Recorder{"video = false\ntracks = false", "run/series.csv"},
        Recorder{"video = false\ntracks = false", "run/report.html"},
        Recorder{"video = false", "run/tracks.h5"}, Recorder{"tracks = false", "run/video.mp4"},
        Recorder{"video = false\ntracks = false\nlossless = true", "run/video.avi"},
        Recorder{"video = false\ntracks = false\nflow = true", "run/flow.h5"}}) {
    const TestFolder f;
    write_file(f.path / "s.toml", kSmallScene + "[record]\ncheckpoint = '0.1 s'\n" + r.record + "\n");
    bool named = false;
    int failed = 0, complete = 0;
    for (const int blocks : {0, 1, 2, 4, 6, 8, 12, 20, 40, 80, 200, 400, 2000, 40000}) {
      const Called c = run_limited(f.path, blocks);
      INFO(r.record, ", ", blocks, " blocks");
      complete_or_marked(f.path / "run", c);
      named = named || c.err.find(r.file) != std::string::npos;
      (c.exit == 0 ? complete : failed) += 1;
    }
    INFO(r.file);
    CHECK(named);
    CHECK(failed > 2);
    CHECK(complete > 0);
  }
}

TEST_CASE("resume with a full disk keeps the mark of the incomplete run") {
  const TestFolder f;
  write_file(f.path / "s.toml", kSmallScene);
  REQUIRE(faba_in(f.path, "run s.toml --seed 1 --quiet --out run").exit == 0);
  write_file(f.path / "run/incomplete",
             "faba process 1\nThis run is not complete. Resume it with: faba resume run\n");
  const std::string command = "cd '" + f.path.string() +
                              "' && ulimit -f 0 && exec '" FABA_PROGRAM
                              "' resume run --quiet > /dev/null 2>&1";
  CHECK(WEXITSTATUS(std::system(command.c_str())) == 1);
  CHECK(read_file(f.path / "run/incomplete").find("This run is not complete. ") != std::string::npos);
}
