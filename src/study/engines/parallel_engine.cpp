// GNU parallel: workers on this machine and on hosts that share the folder of the study.
#include <fmt/format.h>
#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <limits>
#include <map>
#include <utility>

#include "core/error.h"
#include "core/file.h"
#include "core/process/child.h"
#include "core/threads/parallel.h"
#include "study/engines/engines.h"
#include "study/engines/process.h"
#include "study/sweep/study_directory.h"

namespace faba {
namespace {

namespace fs = std::filesystem;
constexpr int kSshFailed = 255;  // exit code of ssh when the host is not reached
constexpr int kNoProgram = 3;    // exit codes of the check of a host
constexpr int kNoFolder = 4;
constexpr int kHostTimeout = 30;  // s, of the check

/// One call of GNU parallel with the attempts of one submission.
struct ParallelCall {
  pid_t process = -1;
  fs::path list;                   ///< tasks and files of each attempt
  fs::path joblog;                 ///< one line for each attempt that ended
  fs::path log;                    ///< messages of GNU parallel and ssh
  std::vector<std::uint64_t> ids;  ///< of the attempts, in their order
  std::vector<bool> ended;
};

/// A line of the file that GNU parallel writes for --joblog: a job that ended.
struct JoblogLine {
  unsigned long number = 0;  ///< of the job, from 1
  std::string host;          ///< as given by --sshlogin, without the number of workers
  int exit = 0, signal = 0;
  std::string where() const { return host == ":" ? "this computer" : "host " + host; }
};

// Columns: Seq, Host, Starttime, JobRuntime, Send, Receive, Exitval, Signal, Command.
std::vector<JoblogLine> lines_of_joblog(const fs::path& file) {
  std::vector<JoblogLine> lines;
  std::ifstream in(file);
  std::string line;
  std::getline(in, line);
  while (std::getline(in, line) && !in.eof()) {
    JoblogLine j;
    char host[256];
    if (std::sscanf(line.c_str(), "%lu\t%255[^\t]\t%*s\t%*s\t%*s\t%*s\t%d\t%d", &j.number, host, &j.exit,
                    &j.signal) != 4)
      continue;
    j.host = host;
    lines.push_back(std::move(j));
  }
  return lines;
}

// What a host has written, of output whose lines start with the name of the host.
std::string message_of_host(const std::string& output, const std::string& host) {
  const auto at = ("\n" + output).find("\n" + host + "\t");
  if (at == std::string::npos) return "";
  const auto begin = at + host.size() + 1;
  return output.substr(begin, output.find_first_of("\r\n", begin) - begin);
}

class ParallelEngine final : public Engine {
 public:
  ParallelEngine(EngineSettings settings, WorkerCommand worker)
      : settings_(std::move(settings)), worker_(std::move(worker)) {
    for (const auto& [program, package] :
         {std::pair{"parallel", "parallel (GNU parallel)"}, std::pair{"setpriv", "util-linux"}})
      if (!program_exists(program))
        throw Error(Errc::usage, "--engine parallel",
                    fmt::format("the program {} is not installed; install the package {}", program, package));
    check_hosts();
    slots_ = settings_.workers > 0
                 ? unsigned(settings_.workers) * unsigned(std::max<std::size_t>(1, settings_.hosts.size()))
             : settings_.hosts.empty() ? number_of_threads(0)
                                       : slots_of_hosts();
  }
  ~ParallelEngine() override { ParallelEngine::cancel(); }

  unsigned slots() const override { return slots_; }
  bool queues() const override { return true; }
  // One call at a time: two would start twice as many workers.
  std::size_t accepts(std::size_t running, bool measured) const override {
    if (running > 0) return 0;
    return measured ? std::numeric_limits<std::size_t>::max() : slots_;
  }
  double period_s() const override { return 0.1; }

  bool submit(std::span<const Attempt> attempts) override {
    ParallelCall call;
    const std::string name = attempts.front().results.stem().string() + "-parallel";
    const fs::path jobs = worker_.directory / study_files::kJobs;
    call.list = jobs / (name + ".list");
    call.joblog = jobs / (name + ".joblog");
    call.log = jobs / (name + ".log");
    std::string lines;
    for (const Attempt& a : attempts) {
      lines += fmt::format("{}\t{}\t{}\n", a.tasks, a.results.string(), a.log.string());
      call.ids.push_back(a.id);
    }
    call.ended.resize(attempts.size());
    write_file(call.list, lines);
    if (!std::exchange(hosts_checked_, true)) check_access(call.list, jobs / (name + "-hosts.joblog"));
    call.process = start_process(words(call.list, call.joblog), {.log = call.log});
    calls_.push_back(std::move(call));
    return true;
  }

  std::vector<AttemptEnd> ended() override {
    std::vector<AttemptEnd> ends;
    for (ParallelCall& call : calls_) {
      const bool over = end_of_process(call.process).has_value();
      read_joblog(call, ends);
      if (!over) continue;
      for (std::size_t k = 0; k < call.ids.size(); ++k)
        if (!call.ended[k]) ends.push_back({call.ids[k], "GNU parallel has ended", -1, {}, message_of(call)});
      remove_files(call);
      call.process = -1;
    }
    std::erase_if(calls_, [](const ParallelCall& c) { return c.process < 0; });
    return ends;
  }

  // After a second SIGTERM, GNU parallel ends its jobs.
  void cancel() override {
    for (int times = 0; times < 2; ++times)
      for (const ParallelCall& call : calls_) kill(call.process, SIGTERM);
    for (const ParallelCall& call : calls_) {
      end_child(call.process, 2);
      remove_files(call);
    }
    calls_.clear();
  }

 private:
  static std::string message_of(const ParallelCall& call) {
    const std::string message = first_message(call.log);
    return message.empty() ? "" : fmt::format("{}, see {}", message, call.log.string());
  }

  static void remove_files(const ParallelCall& call) {
    std::error_code ec;
    for (const fs::path& file : {call.list, call.joblog}) fs::remove(file, ec);
    remove_if_empty(call.log);
  }

  // GNU parallel reports a wrong number as an error of its own.
  void check_hosts() const {
    for (const std::string& host : settings_.hosts) {
      const auto slash = host.find('/');
      if (slash == std::string::npos || host.starts_with("@") ||
          host.substr(0, slash).find_first_not_of("0123456789") == std::string::npos)
        continue;
      throw Error(Errc::usage, "--sshlogin",
                  fmt::format("\"{}\" does not start with a number of workers; write NUMBER/HOST, such as "
                              "4/user@pc2",
                              host));
    }
  }

  // A host that is not reached, or has no Faba, would end one worker after the other. `shared`: a file of
  // the study that was just written.
  void check_access(const fs::path& shared, const fs::path& joblog) const {
    const bool remote = std::ranges::any_of(
        settings_.hosts, [](const std::string& h) { return h != ":" && !h.ends_with("/:"); });
    if (!remote) return;
    std::vector<std::string> w{"parallel", "--no-notice",  "--nonall",
                               "--tag",    "--timeout",    std::to_string(kHostTimeout),
                               "--joblog", joblog.string()};
    for (const std::string& host : settings_.hosts) w.insert(w.end(), {"--sshlogin", host});
    w.push_back(fmt::format("test -x {} || exit {}; test -r {} || exit {}",
                            shell_word(worker_.program.string()), kNoProgram, shell_word(shared.string()),
                            kNoFolder));
    const CommandOutput answer = run_command(w, true);
    const std::vector<JoblogLine> hosts = lines_of_joblog(joblog);
    std::error_code ec;
    fs::remove(joblog, ec);
    for (const JoblogLine& j : hosts) {
      if (j.exit == 0 && j.signal == 0) continue;
      fs::remove(shared, ec);
      throw Error(Errc::usage, "--sshlogin",
                  fmt::format("{} {}; correct or omit it", j.where(),
                              refusal(j, message_of_host(answer.out, j.host))));
    }
  }

  // Why a host cannot compute tasks.
  std::string refusal(const JoblogLine& j, const std::string& message) const {
    if (j.exit == kNoProgram)
      return fmt::format("has no program {}: the same build of Faba must be installed there",
                         worker_.program.string());
    if (j.exit == kNoFolder)
      return fmt::format("cannot read the directory {}: all hosts must mount it at the same place",
                         worker_.directory.string());
    const std::string why = message.empty() ? fmt::format("no answer within {} s", kHostTimeout) : message;
    return fmt::format("was not reached ({}): ssh must work without a password", why);
  }

  // "4/user@host" has four workers; a host without a number has one.
  unsigned slots_of_hosts() const {
    unsigned sum = 0;
    for (const std::string& host : settings_.hosts) {
      const auto slash = host.find('/');
      sum += slash == std::string::npos ? 1 : unsigned(std::max(1, std::atoi(host.c_str())));
    }
    return sum;
  }

  std::vector<std::string> words(const fs::path& list, const fs::path& joblog) const {
    std::string command = "exec 2>> {3}; ";
    for (const std::string& line : settings_.environment) command += line + "; ";
    command += "exec ";  // the worker replaces the shell, and ends with the process that started it
    const Attempt pattern{0, "{1}", "{2}", "{3}"};
    for (const std::string& word : worker_.words(pattern))
      command += (word.starts_with("{") ? word : shell_word(word)) + " ";
    command += "--parent $PPID";
    // When this command dies, GNU parallel ends its jobs and itself; the shell ends it if the command died
    // before setpriv.
    std::vector<std::string> w{"setpriv",
                               "--pdeathsig",
                               "TERM",
                               "sh",
                               "-c",
                               fmt::format("[ $PPID = {} ] && exec \"$@\"", getpid()),
                               "sh",
                               "parallel",
                               "--no-notice",
                               "--colsep",
                               "\t",
                               "--joblog",
                               joblog.string(),
                               "--wd",
                               fs::current_path().string(),
                               "--arg-file",
                               list.string()};
    if (settings_.workers > 0 || settings_.hosts.empty())
      w.insert(w.end(), {"--jobs", std::to_string(settings_.workers > 0 ? settings_.workers : int(slots_))});
    for (const std::string& host : settings_.hosts) w.insert(w.end(), {"--sshlogin", host});
    // A host that is lost meanwhile would end the attempts of all others.
    if (settings_.hosts.size() > 1) w.insert(w.end(), {"--retries", std::to_string(settings_.hosts.size())});
    w.push_back(command);
    return w;
  }

  static void read_joblog(ParallelCall& call, std::vector<AttemptEnd>& ends) {
    for (const JoblogLine& j : lines_of_joblog(call.joblog)) {
      if (j.number < 1 || j.number > call.ids.size() || call.ended[j.number - 1]) continue;
      call.ended[j.number - 1] = true;
      ends.push_back({call.ids[j.number - 1], end_text(j.signal != 0 ? -j.signal : j.exit),
                      j.signal != 0 ? -1 : j.exit, j.where(), j.exit == kSshFailed ? message_of(call) : ""});
    }
  }

  EngineSettings settings_;
  WorkerCommand worker_;
  unsigned slots_ = 1;
  bool hosts_checked_ = false;
  std::vector<ParallelCall> calls_;
};

}  // namespace

std::unique_ptr<Engine> parallel_engine(const EngineSettings& settings, const WorkerCommand& worker) {
  return std::make_unique<ParallelEngine>(settings, worker);
}

}  // namespace faba
