#include "app/bench/bench_process.h"

#include <fmt/format.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <cstring>
#include <thread>

#include "core/file.h"
#include "core/monotonic.h"
#include "core/process/child.h"
#include "core/process/installation.h"
#include "rig/bench/bench_socket.h"

namespace faba {
namespace {

constexpr double kStartTimeout = 30;  // s, long enough to place a large swarm
constexpr double kExitTimeout = 5;    // s from SIGTERM to SIGKILL

[[noreturn]] void fail(const std::string& what) { throw Error(Errc::device, "simulated bench", what); }

}  // namespace

BenchProcess::BenchProcess(const Scenario& s, std::uint64_t seed) {
  std::string name = (std::filesystem::temp_directory_path() / "faba-XXXXXX").string();
  if (!mkdtemp(name.data())) fail(fmt::format("{} cannot be created: {}", name, std::strerror(errno)));
  folder_ = name;
  const std::string scene = (folder_ / "scene.toml").string(), at = this->at(),
                    seed_text = std::to_string(seed);
  // The bench has no control loop; the parts of the run may be classes in Python, which the program lacks.
  Json bench = s.resolved();
  for (const char* part : {"estimator", "reference", "controller", "event"}) bench.erase(part);
  write_file(scene, to_toml(bench));
  const std::string program = program_file("faba").string();
  std::vector<const char*> arguments = {
      program.c_str(), "rig",     "simulate", scene.c_str(),     "--at", at.c_str(),
      "--once",        "--quiet", "--seed",   seed_text.c_str(), nullptr};
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSID);  // Ctrl-C is handled by the run only
  const int error = posix_spawn(&process_, program.c_str(), nullptr, &attributes,
                                const_cast<char* const*>(arguments.data()), environ);
  posix_spawnattr_destroy(&attributes);
  if (error != 0) fail(fmt::format("cannot be started: {}", std::strerror(error)));
  const double until = monotonic_now() + kStartTimeout;
  std::error_code ec;
  while (!std::filesystem::exists(at, ec)) {
    if (waitpid(process_, nullptr, WNOHANG) != 0) {
      process_ = -1;
      end();
      fail("the process exited during its start");
    }
    if (monotonic_now() > until) {
      end();
      fail(fmt::format("did not start within {:g} s", kStartTimeout));
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  std::filesystem::remove(scene, ec);  // it has been read
}

BenchProcess::~BenchProcess() { end(); }

void BenchProcess::end() noexcept {
  if (process_ > 0) {
    kill(process_, SIGTERM);
    end_child(process_, kExitTimeout);
  }
  std::error_code ec;
  std::filesystem::remove_all(folder_, ec);
}

}  // namespace faba
