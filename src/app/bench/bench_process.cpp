#include "app/bench/bench_process.h"

#include <fmt/format.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <cstring>
#include <thread>

#include "core/child.h"
#include "core/file.h"
#include "core/monotonic.h"
#include "rig/bench/bench_socket.h"

namespace faba {
namespace {

constexpr double kPatience = 30;  // s for a large swarm to be placed
constexpr double kEnding = 5;     // s for it to end when told

[[noreturn]] void fail(const std::string& what) { throw Error(Errc::device, "simulated bench", what); }

}  // namespace

BenchProcess::BenchProcess(const Scenario& s, std::uint64_t seed) {
  std::string name = (std::filesystem::temp_directory_path() / "faba-XXXXXX").string();
  if (!mkdtemp(name.data())) fail(fmt::format("{} cannot be made: {}", name, std::strerror(errno)));
  folder_ = name;
  const std::string scene = (folder_ / "scene.toml").string(), at = this->at(),
                    seed_word = std::to_string(seed);
  write_file(scene, to_toml(s.resolved()));
  const std::string program = std::filesystem::read_symlink("/proc/self/exe").string();
  std::vector<const char*> words = {program.c_str(), "rig",    "simulate", scene.c_str(), "--at",
                                    at.c_str(),      "--once", "--quiet",  "--seed",      seed_word.c_str(),
                                    nullptr};
  posix_spawnattr_t how;
  posix_spawnattr_init(&how);
  posix_spawnattr_setflags(&how, POSIX_SPAWN_SETSID);  // Ctrl-C is the run's
  const int wrong =
      posix_spawn(&process_, program.c_str(), nullptr, &how, const_cast<char* const*>(words.data()), environ);
  posix_spawnattr_destroy(&how);
  if (wrong != 0) fail(std::strerror(wrong));
  const double until = monotonic_now() + kPatience;
  std::error_code ec;
  while (!std::filesystem::exists(at, ec)) {
    if (waitpid(process_, nullptr, WNOHANG) != 0) {
      process_ = -1;
      end();
      fail("ended before it was there");
    }
    if (monotonic_now() > until) {
      end();
      fail("takes too long");
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  std::filesystem::remove(scene, ec);  // it has been read; what is killed now leaves no more than a folder
}

BenchProcess::~BenchProcess() { end(); }

void BenchProcess::end() noexcept {
  if (process_ > 0) {
    kill(process_, SIGTERM);
    end_child(process_, kEnding);
  }
  std::error_code ec;
  std::filesystem::remove_all(folder_, ec);
}

}  // namespace faba
