#include "study/engines/process.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <fstream>
#include <system_error>

#include "core/error.h"
#include "core/process/child.h"

namespace faba {

pid_t start_process(const std::vector<std::string>& words, const ChildFiles& files) {
  std::vector<char*> arguments;
  arguments.reserve(words.size() + 1);
  for (const std::string& w : words) arguments.push_back(const_cast<char*>(w.c_str()));
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  const auto connect = [&](int from, int to, int how) {
    if (from >= 0)
      posix_spawn_file_actions_adddup2(&actions, from, to);
    else
      posix_spawn_file_actions_addopen(&actions, to, "/dev/null", how, 0);
  };
  connect(files.in, STDIN_FILENO, O_RDONLY);
  connect(files.out, STDOUT_FILENO, O_WRONLY);
  const std::string log = files.log.empty() ? "/dev/null" : files.log.string();
  posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, log.c_str(), O_WRONLY | O_CREAT | O_APPEND, 0666);
  posix_spawn_file_actions_addclosefrom_np(&actions, STDERR_FILENO + 1);
  pid_t process = -1;
  const int error = posix_spawnp(&process, arguments[0], &actions, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (error != 0)
    throw Error(Errc::internal, words[0],
                fmt::format("cannot be started: {}", std::generic_category().message(error)));
  return process;
}

std::optional<int> end_of_process(pid_t process, bool wait) {
  int status = 0;
  pid_t ended = -1;
  do ended = waitpid(process, &status, wait ? 0 : WNOHANG);
  while (ended < 0 && errno == EINTR);
  if (ended != process) return {};
  if (WIFSIGNALED(status)) return -WTERMSIG(status);
  return WEXITSTATUS(status);
}

std::string end_text(int end) {
  return end < 0 ? fmt::format("signal {}", -end) : fmt::format("exit code {}", end);
}

CommandOutput run_command(const std::vector<std::string>& words, bool with_errors) {
  std::string line;
  for (const std::string& w : words) line += shell_word(w) + " ";
  line += with_errors ? "2>&1" : "2> /dev/null";
  FILE* pipe = popen((line + " < /dev/null").c_str(), "re");
  if (!pipe) return {127, ""};
  CommandOutput c;
  char buffer[4096];
  for (std::size_t n; (n = std::fread(buffer, 1, sizeof buffer, pipe)) > 0;) c.out.append(buffer, n);
  const int status = pclose(pipe);
  c.exit = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  return c;
}

namespace {

std::vector<std::string> messages(const std::filesystem::path& log) {
  std::ifstream in(log);
  std::vector<std::string> lines;
  for (std::string line; std::getline(in, line);) {
    line.erase(line.find_last_not_of("\r ") + 1);  // ssh ends its lines with CR and LF
    if (!line.empty() && line.find("Warning") == std::string::npos) lines.push_back(line);
  }
  return lines;
}

}  // namespace

std::string first_message(const std::filesystem::path& log) {
  const auto lines = messages(log);
  return lines.empty() ? "" : lines.front();
}

std::string last_message(const std::filesystem::path& log) {
  const auto lines = messages(log);
  return lines.empty() ? "" : lines.back();
}

void remove_if_empty(const std::filesystem::path& log) {
  std::error_code ec;
  if (std::filesystem::file_size(log, ec) == 0 && !ec) std::filesystem::remove(log, ec);
}

bool program_exists(const std::string& name) {
  return run_command({"sh", "-c", "command -v " + shell_word(name)}).exit == 0;
}

}  // namespace faba
