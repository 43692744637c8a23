#include "server/jobs/job_list.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstring>

#include "core/error.h"
#include "server/jobs/job_archive.h"

namespace faba {
namespace {

constexpr std::size_t kMostOutput = 16u << 20;
constexpr int kPollMs = 100;
constexpr double kReportPeriod = 0.2;  // s
constexpr double kKillDelay = 5;       // s, timeout between SIGINT and SIGKILL
constexpr int kProgressFd = 3;
constexpr std::size_t kKept = 100;  // maximum length of the job list

/// Both ends of a pipe, closed by the destructor.
struct Pipe {
  int read_end = -1, write_end = -1;
  Pipe() {
    int ends[2];
    if (::pipe2(ends, O_CLOEXEC) != 0) throw Error(Errc::internal, "job", std::strerror(errno));
    read_end = ends[0];
    write_end = ends[1];
    ::fcntl(read_end, F_SETFL, O_NONBLOCK);
  }
  ~Pipe() {
    close_write();
    ::close(read_end);
  }
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;
  void close_write() {
    if (write_end >= 0) ::close(write_end);
    write_end = -1;
  }
  /// Appends all available data; false at the end of the stream.
  bool drain(std::string& into) const {
    std::array<char, 65536> buffer;
    for (;;) {
      const ssize_t n = ::read(read_end, buffer.data(), buffer.size());
      if (n == 0) return false;
      if (n < 0) return errno == EAGAIN || errno == EINTR;
      if (into.size() < kMostOutput) into.append(buffer.data(), std::size_t(n));
    }
  }
};

// The last complete line of the progress, such as "simulating 40 300".
void read_progress(std::string& text, Job& job) {
  const auto end = text.rfind('\n');
  if (end == std::string::npos) return;
  const auto before = end == 0 ? std::string::npos : text.rfind('\n', end - 1);
  const std::string line = text.substr(before == std::string::npos ? 0 : before + 1, end);
  text.erase(0, end + 1);
  const auto total = line.rfind(' '), done = total == std::string::npos ? total : line.rfind(' ', total - 1);
  if (done == std::string::npos) return;
  job.doing = line.substr(0, done);
  job.did = std::strtoull(line.c_str() + done + 1, nullptr, 10);
  job.of = std::strtoull(line.c_str() + total + 1, nullptr, 10);
}

// The error message of a verb is the last line of its standard error, without the command that prints its
// help: a page has no command line.
std::string last_line(std::string text) {
  while (!text.empty() && text.back() == '\n') text.pop_back();
  const auto cut = text.rfind('\n');
  if (cut != std::string::npos) text.erase(0, cut + 1);
  constexpr std::string_view kMark = "faba: error: ";
  if (text.starts_with(kMark)) text.erase(0, kMark.size());
  const auto help = text.rfind(" (see ");
  if (help != std::string::npos && text.ends_with(" --help)")) text.erase(help);
  return text;
}

int next_id(const std::vector<Job>& jobs) {
  int next = 1;
  for (const Job& j : jobs) next = std::max(next, j.id + 1);
  return next;
}

}  // namespace

/// A process of the program with three pipes: standard output, standard error, progress.
struct JobList::Process {
  Pipe out, err, progress;
  pid_t pid = -1;

  Process(const std::filesystem::path& program, const std::filesystem::path& folder,
          const std::vector<std::string>& words) {
    std::vector<std::string> all = {program.string()};
    all.insert(all.end(), words.begin(), words.end());
    std::vector<char*> argv;
    argv.reserve(all.size() + 1);
    for (std::string& w : all) argv.push_back(w.data());
    argv.push_back(nullptr);
    std::string variable = "FABA_PROGRESS_FD=" + std::to_string(kProgressFd);
    std::size_t inherited = 0;
    while (environ[inherited]) ++inherited;
    std::vector<char*> env(environ, environ + inherited);
    env.push_back(variable.data());
    env.push_back(nullptr);

    posix_spawn_file_actions_t files;
    posix_spawn_file_actions_init(&files);
    posix_spawn_file_actions_addopen(&files, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_adddup2(&files, out.write_end, STDOUT_FILENO);
    posix_spawn_file_actions_adddup2(&files, err.write_end, STDERR_FILENO);
    posix_spawn_file_actions_adddup2(&files, progress.write_end, kProgressFd);
    // Jobs inherit no descriptors of the lab: otherwise the port would stay in use while the job runs.
    posix_spawn_file_actions_addclosefrom_np(&files, kProgressFd + 1);
    posix_spawn_file_actions_addchdir_np(&files, folder.c_str());
    posix_spawnattr_t how;
    posix_spawnattr_init(&how);
    posix_spawnattr_setflags(&how, POSIX_SPAWN_SETPGROUP);  // only the lab handles Ctrl-C
    const int wrong = posix_spawn(&pid, program.c_str(), &files, &how, argv.data(), env.data());
    posix_spawnattr_destroy(&how);
    posix_spawn_file_actions_destroy(&files);
    if (wrong != 0) throw Error(Errc::internal, program.string(), std::strerror(wrong));
    out.close_write();
    err.close_write();
    progress.close_write();
  }
};

JobList::JobList(std::filesystem::path program, std::filesystem::path workspace,
                 std::function<void()> changed, std::function<void(const Job&)> check)
    : program_(std::move(program)),
      workspace_(std::move(workspace)),
      changed_(std::move(changed)),
      check_(std::move(check)),
      jobs_(kept_jobs(workspace_, kKept)),
      next_(next_id(jobs_)),
      thread_([this](const std::stop_token& s) { work(s); }) {}

JobList::~JobList() {
  thread_.request_stop();
  wake_.notify_all();
}

int JobList::add(Job job) {
  int id = 0;
  {
    const std::lock_guard lock(mutex_);
    id = job.id = next_++;
    jobs_.push_back(std::move(job));
    if (jobs_.size() > kKept)
      if (const auto oldest = std::find_if(jobs_.begin(), jobs_.end(), is_over); oldest != jobs_.end())
        jobs_.erase(oldest);
  }
  wake_.notify_all();
  changed_();
  return id;
}

std::vector<Job>::iterator JobList::find(int id) {
  return std::find_if(jobs_.begin(), jobs_.end(), [id](const Job& j) { return j.id == id; });
}

bool JobList::move_to_front(int id) {
  {
    const std::lock_guard lock(mutex_);
    const auto is_waiting = [](const Job& j) { return j.state == Job::State::waiting; };
    const auto it = find(id);
    if (it == jobs_.end() || !is_waiting(*it)) return false;
    std::rotate(std::find_if(jobs_.begin(), it, is_waiting), it, it + 1);
  }
  changed_();
  return true;
}

bool JobList::start_again(int id) {
  {
    const std::lock_guard lock(mutex_);
    const auto it = find(id);
    if (it == jobs_.end() || !is_over(*it) || it->state == Job::State::done) return false;
    Job again{.id = id,
              .title = it->title,
              .words = it->words,
              .page = it->page,
              .out = it->out,
              .kind = it->kind,
              .work = it->work,
              .estimate_s = it->estimate_s,
              .estimate_measured = it->estimate_measured};
    jobs_.erase(it);
    jobs_.push_back(std::move(again));
  }
  wake_.notify_all();
  changed_();
  return true;
}

bool JobList::clear(std::optional<int> id) {
  std::vector<Job> removed;
  {
    const std::lock_guard lock(mutex_);
    const auto goes = [&](const Job& j) { return is_over(j) && (!id || j.id == *id); };
    std::copy_if(jobs_.begin(), jobs_.end(), std::back_inserter(removed), goes);
    std::erase_if(jobs_, goes);
  }
  for (const Job& j : removed) forget_job(workspace_, j);
  changed_();
  return !removed.empty() || !id;
}

bool JobList::cancel(int id) {
  {
    const std::lock_guard lock(mutex_);
    const auto it = find(id);
    if (it == jobs_.end()) return false;
    if (it->state == Job::State::waiting)
      it->state = Job::State::cancelled;
    else if (it->state == Job::State::running)
      cancel_ = id;
  }
  changed_();
  return true;
}

std::vector<Job> JobList::jobs() const {
  const std::lock_guard lock(mutex_);
  return jobs_;
}

std::optional<Job> JobList::job(int id) const {
  const std::lock_guard lock(mutex_);
  for (const Job& j : jobs_)
    if (j.id == id) return j;
  return {};
}

void JobList::report(const Job& job) {
  {
    const std::lock_guard lock(mutex_);
    for (Job& j : jobs_)
      if (j.id == job.id) j = job;
  }
  changed_();
}

void JobList::work(const std::stop_token& stop) {
  while (!stop.stop_requested()) {
    Job job;
    {
      std::unique_lock lock(mutex_);
      const auto waiting = [&] {
        return std::find_if(jobs_.begin(), jobs_.end(),
                            [](const Job& j) { return j.state == Job::State::waiting; });
      };
      wake_.wait(lock, [&] { return stop.stop_requested() || waiting() != jobs_.end(); });
      if (stop.stop_requested()) return;
      job = *waiting();
    }
    job.state = Job::State::running;
    report(job);
    try {
      if (check_) check_(job);
      carry_out(job, stop);
    } catch (const std::exception& e) {
      job.state = Job::State::failed;
      job.error = e.what();
    }
    job.ended = double(
        std::chrono::duration_cast<std::chrono::seconds>(std::chrono::system_clock::now().time_since_epoch())
            .count());
    keep_job(workspace_, job);
    report(job);
  }
}

void JobList::carry_out(Job& job, const std::stop_token& stop) {
  using Clock = std::chrono::steady_clock;
  Process process(program_, workspace_, job.words);
  const auto began = Clock::now();
  const auto since = [](Clock::time_point t) {
    return std::chrono::duration<double>(Clock::now() - t).count();
  };
  std::optional<Clock::time_point> asked;
  auto reported = began;
  std::string out, err, progress;
  bool killed = false;
  for (bool open = true; open;) {
    std::array<pollfd, 3> fds = {{{process.out.read_end, POLLIN, 0},
                                  {process.err.read_end, POLLIN, 0},
                                  {process.progress.read_end, POLLIN, 0}}};
    ::poll(fds.data(), fds.size(), kPollMs);
    const bool more_out = process.out.drain(out), more_err = process.err.drain(err);
    process.progress.drain(progress);
    open = more_out || more_err;
    read_progress(progress, job);
    job.seconds = since(began);
    if ((cancel_ == job.id || stop.stop_requested()) && !asked) {
      asked = Clock::now();
      ::kill(process.pid, SIGINT);
    }
    if (asked && !killed && since(*asked) > kKillDelay) {
      killed = true;
      ::kill(process.pid, SIGKILL);
    }
    if (since(reported) > kReportPeriod) {
      reported = Clock::now();
      report(job);
    }
    if (!more_out && more_err) ::usleep(kPollMs * 1000 / 10);  // poll() returns at once on a closed pipe
  }
  int status = 0;
  while (::waitpid(process.pid, &status, 0) < 0 && errno == EINTR) {
  }
  cancel_ = 0;
  job.result = Json::parse(out, nullptr, false);
  if (job.result.is_discarded()) job.result = Json();
  if (asked) {
    job.state = Job::State::cancelled;
  } else if (WIFEXITED(status) && WEXITSTATUS(status) == 0) {
    job.state = Job::State::done;
  } else {
    job.state = Job::State::failed;
    job.error = WIFEXITED(status) ? last_line(err) : "killed by signal " + std::to_string(WTERMSIG(status));
  }
}

}  // namespace faba
