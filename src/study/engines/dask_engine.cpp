// Dask: workers of a Dask cluster, by a Python program that is part of faba (dask_program.py).
#include <fmt/format.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "core/error.h"
#include "core/file.h"
#include "core/process/child.h"
#include "study/engines/engines.h"
#include "study/engines/process.h"
#include "study/sweep/study_directory.h"

namespace faba {
namespace {

namespace fs = std::filesystem;
constexpr const char* kDaskProgram =
#include "dask_program.inc"
    ;
constexpr int kStartTimeout = 120000;  // ms
constexpr const char* kAway = "away";  // line of the program while it is not connected to the scheduler

class DaskEngine final : public Engine {
 public:
  DaskEngine(const EngineSettings& settings, WorkerCommand worker)
      : worker_(std::move(worker)), scheduler_(settings.scheduler) {
    if (run_command({settings.python, "-c", "import distributed"}).exit != 0)
      throw Error(
          Errc::usage, "--engine dask",
          fmt::format("{} has no package distributed; install python3-distributed, or set python to an "
                      "interpreter that has it",
                      settings.python));
    const fs::path jobs = worker_.directory / study_files::kJobs, program = jobs / "dask_program.py";
    fs::create_directories(jobs);
    write_file(program, kDaskProgram);
    log_ = jobs / "dask.log";
    int both[2];
    if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, both) != 0)
      throw Error(Errc::internal, "--engine dask", "no connection to a child process can be created");
    std::vector<std::string> words{settings.python, program.string(), "--workers",
                                   std::to_string(settings.workers)};
    if (!settings.scheduler.empty()) words.insert(words.end(), {"--scheduler", settings.scheduler});
    process_ = start_process(words, {.in = both[0], .out = both[0], .log = log_});
    ::close(both[0]);
    connection_ = both[1];
    wait_for_connection();
  }
  ~DaskEngine() override {
    DaskEngine::cancel();
    ::close(connection_);  // the program ends at the end of its input
    end_child(process_, 10);
    remove_if_empty(log_);
  }

  unsigned slots() const override { return slots_; }
  double period_s() const override { return 0.02; }
  std::string trouble() const override {
    if (away_) return fmt::format("the Dask scheduler {} is not available; waiting for it", scheduler_);
    if (workers_ > 0) return {};
    if (scheduler_.empty()) return "no worker of Dask runs";
    return fmt::format("the Dask scheduler {} has no workers; start some by: dask worker {}", scheduler_,
                       scheduler_);
  }

  bool submit(std::span<const Attempt> attempts) override {
    for (const Attempt& a : attempts) {
      const nlohmann::json line{{"id", a.id}, {"words", worker_.words(a)}, {"log", a.log.string()}};
      const std::string text = line.dump() + "\n";
      if (::send(connection_, text.data(), text.size(), MSG_NOSIGNAL) != ssize_t(text.size())) return false;
      running_.insert(a.id);
    }
    return true;
  }

  std::vector<AttemptEnd> ended() override {
    std::vector<AttemptEnd> ends;
    for (std::string line; next_line(line, 0);) {
      if (read_state(line)) continue;
      std::uint64_t id = 0;
      int exit = -1, text = 0;
      if (std::sscanf(line.c_str(), "end %lu %d %n", &id, &exit, &text) != 2 || running_.erase(id) == 0)
        continue;
      AttemptEnd& end = ends.emplace_back(AttemptEnd{id, end_text(exit), std::max(-1, exit)});
      if (text < int(line.size())) end.how = line.substr(std::size_t(text));
    }
    if (over_ && !running_.empty())
      throw Error(
          Errc::internal, log_.string(),
          fmt::format("the program that uses Dask has ended ({}); run the same command again to continue",
                      last_message(log_)));
    return ends;
  }

  void cancel() override { running_.clear(); }

 private:
  // Whether a line has the state of Dask. Workers can come and go.
  bool read_state(const std::string& line) {
    if (line == kAway) return away_ = true;
    if (std::sscanf(line.c_str(), "workers %u slots %u", &workers_, &slots_) != 2) return false;
    away_ = false;
    return true;
  }

  void wait_for_connection() {
    std::string line;
    while (next_line(line, kStartTimeout))
      if (read_state(line)) return;
    const std::string message = last_message(log_);
    throw Error(
        Errc::internal, "--engine dask",
        scheduler_.empty()
            ? fmt::format("no Dask cluster could be started; see {}", log_.string())
            : fmt::format("the Dask scheduler {} was not reached{}; correct the address, or start the "
                          "scheduler by: dask scheduler. See {}",
                          scheduler_, message.empty() ? "" : " (" + message + ")", log_.string()));
  }

  // The next line of the program; false when no line comes within `timeout` ms.
  bool next_line(std::string& line, int timeout) {
    for (std::size_t end = 0;;) {
      if ((end = text_.find('\n')) != std::string::npos) {
        line = text_.substr(0, end);
        text_.erase(0, end + 1);
        return true;
      }
      pollfd p{connection_, POLLIN, 0};
      if (over_ || ::poll(&p, 1, timeout) <= 0) return false;
      char buffer[4096];
      const ssize_t n = ::read(connection_, buffer, sizeof buffer);
      if (n <= 0)
        over_ = true;
      else
        text_.append(buffer, std::size_t(n));
    }
  }

  WorkerCommand worker_;
  std::string scheduler_;  ///< empty: workers on this machine
  fs::path log_;
  pid_t process_ = -1;
  int connection_ = -1;
  unsigned slots_ = 1, workers_ = 1;
  std::string text_;
  bool over_ = false;
  bool away_ = false;  ///< the scheduler is not available
  std::set<std::uint64_t> running_;
};

}  // namespace

std::unique_ptr<Engine> dask_engine(const EngineSettings& settings, const WorkerCommand& worker) {
  return std::make_unique<DaskEngine>(settings, worker);
}

}  // namespace faba
