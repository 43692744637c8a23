#include <fmt/format.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <termios.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <optional>

#include "app/bench/open_bench.h"
#include "cli/command_line.h"
#include "cli/options/bench.h"
#include "cli/quantity.h"
#include "core/monotonic.h"

namespace faba::cli {
namespace {

struct JogVerb {
  SceneOptions run;
  std::string step = "50 mA";
};

constexpr double kTurn = 0.02;     // s between requests
constexpr double kPipedKey = 0.1;  // s that a key counts before the next, when keys come from no terminal

void print_keys(std::size_t coils) {
  fmt::print(
      "{}    up + down -  a step    page up, page down  largest, smallest    0  none\n"
      "a  arm    space  no current anywhere    r  after a fault: ready to be armed    q  end\n",
      coils > 1 ? fmt::format("1 ... {} choose coil 0 ... coil {}", std::min<std::size_t>(coils, 9),
                              std::min<std::size_t>(coils, 9) - 1)
                : "coil 0");
}

// Keys one by one, as they are pressed.
class Keyboard {
 public:
  Keyboard() : terminal_(isatty(STDIN_FILENO) != 0) {
    if (!terminal_) return;
    tcgetattr(STDIN_FILENO, &before_);
    termios raw = before_;
    raw.c_lflag &= ~tcflag_t(ICANON | ECHO);  // Ctrl-C stays what it is
    raw.c_cc[VMIN] = 0;
    raw.c_cc[VTIME] = 0;
    tcsetattr(STDIN_FILENO, TCSANOW, &raw);
  }
  ~Keyboard() {
    if (terminal_) tcsetattr(STDIN_FILENO, TCSANOW, &before_);
  }
  Keyboard(const Keyboard&) = delete;
  Keyboard& operator=(const Keyboard&) = delete;

  /// The next key within kTurn: a letter, or 'U', 'D', 'P', 'N' for up, down, page up and page down. 0: none;
  /// 'q' when there will be no more.
  char next() {
    pollfd ready{STDIN_FILENO, POLLIN, 0};
    if (!terminal_ && monotonic_now() < not_before_) {
      wait_a_turn();
      return 0;
    }
    if (poll(&ready, 1, int(1e3 * kTurn)) <= 0) return 0;
    const char key = get();
    not_before_ = monotonic_now() + kPipedKey;
    if (key != '\033') return key;
    if (get() != '[') return 0;
    const char what = get();
    if (what == '5' || what == '6') get();  // a ~ follows
    return what == 'A' ? 'U' : what == 'B' ? 'D' : what == '5' ? 'P' : what == '6' ? 'N' : '\0';
  }
  bool terminal() const { return terminal_; }

 private:
  static void wait_a_turn() { poll(nullptr, 0, int(1e3 * kTurn)); }
  static char get() {
    char c = 0;
    return read(STDIN_FILENO, &c, 1) == 1 ? c : 'q';
  }
  termios before_{};
  bool terminal_;
  double not_before_ = 0;  ///< s
};

// Towards what is asked, no faster than the guard allows.
void approach(std::vector<double>& current, const std::vector<double>& asked, std::optional<double> slew,
              double dt) {
  for (std::size_t k = 0; k < current.size(); ++k) {
    const double most = slew ? *slew * dt : std::numeric_limits<double>::infinity();
    current[k] += std::clamp(asked[k] - current[k], -most, most);
  }
}

// What of a line a terminal shows in one.
std::string cut_to_terminal(std::string line) {
  winsize size{};
  if (ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 1 && line.size() >= size.ws_col)
    line.resize(size.ws_col - 1U);
  return line;
}

std::string line_of(const GuardReport& g, const std::vector<double>& asked, std::size_t chosen) {
  if (g.state == CoilGuard::State::faulted)
    return fmt::format("faulted  {}{}; r makes it ready to be armed", g.reason.data(),
                       g.obeyed ? "" : "; could not be told to rest: switch it off by hand");
  std::string line = fmt::format("{:<8}", word(g.state));
  for (std::size_t k = 0; k < asked.size(); ++k) {
    line += fmt::format(" {}coil {}: {:+.3f} A", k == chosen ? "[" : " ", k, asked[k]);
    if (!std::isnan(g.sensed[k])) line += fmt::format(", sensed {:+.3f}", g.sensed[k]);
    line += k == chosen ? "]" : " ";
  }
  if (g.reason[0])
    line += fmt::format("  {}", g.reason.data());
  else if (g.state == CoilGuard::State::disarmed)
    line += "  a arms it";
  return line;
}

int rig_jog(const JogVerb& v, const Common& c) {
  Scenario s = read_bench_scene(v.run);
  if (!s.rig) throw Error(Errc::usage, "rig", "the scenario has no [rig], the bench whose coils these are");
  const double step = quantity_of(v.step, "A", "--step", "50 mA");
  if (!(step > 0)) throw Error(Errc::usage, "--step", "must be above zero");
  if (const double largest = std::ranges::max(s.rig->max_current()); step > largest)
    throw Error(Errc::usage, "--step",
                fmt::format("is {:g} A, and no coil of this bench takes more than {:g} A", step, largest));
  const OpenBench bench(s, s.params.seed.value_or(1), OpenBench::Open::coils);
  GuardLink coils(bench.guard_setup({}));
  const std::vector<double> most = s.rig->max_current();
  std::vector<double> asked(most.size(), 0.0);
  std::vector<double> put = asked;  // as far as they have come
  double last = monotonic_now();    // s, of the request before
  std::size_t chosen = 0;
  std::string shown;
  Keyboard keys;
  const bool speaks = !c.quiet && !c.json;
  if (speaks) print_keys(most.size());
  while (!stop_requested().load()) {
    const char key = keys.next();
    double& one = asked[chosen];
    if (key == 'q') break;
    if (key >= '1' && key <= '9' && std::size_t(key - '1') < asked.size()) chosen = std::size_t(key - '1');
    if (key == 'U' || key == '+') one = std::min(most[chosen], one + step);
    if (key == 'D' || key == '-') one = std::max(-most[chosen], one - step);
    if (key == 'P') one = most[chosen];
    if (key == 'N') one = -most[chosen];
    if (key == '0') one = 0;
    if (key == ' ') std::fill(asked.begin(), asked.end(), 0.0);
    const GuardReport before = coils.report();
    if (key == 'r' && before.state == CoilGuard::State::faulted) coils.reset();
    if (before.state != CoilGuard::State::armed) {
      std::fill(asked.begin(), asked.end(), 0.0);  // current comes from nothing but a key
      std::fill(put.begin(), put.end(), 0.0);
      if (key == 'a' && before.state == CoilGuard::State::disarmed) coils.arm();
    }
    const double now = monotonic_now();
    approach(put, asked, s.rig->guard.max_slew, now - last);
    last = now;
    coils.request(put, now);
    const std::string line = line_of(coils.report(), asked, chosen);
    if (line == shown || !speaks) continue;
    fmt::print("{}{}{}", keys.terminal() ? "\r\033[K" : "", keys.terminal() ? cut_to_terminal(line) : line,
               keys.terminal() ? "" : "\n");
    std::fflush(stdout);
    shown = line;
  }
  if (keys.terminal() && speaks) fmt::print("\n");
  coils.disarm();
  const GuardReport g = coils.report();
  if (c.json) fmt::print("{}\n", Json{{"state", word(g.state)}, {"reason", g.reason.data()}}.dump());
  if (stop_requested().load()) return int(Errc::interrupted);
  return g.state == CoilGuard::State::faulted ? int(Errc::device) : 0;
}

}  // namespace

void add_rig_jog(CLI::App& rig, CommandLine& line) {
  const auto o = std::make_shared<JogVerb>();
  CLI::App* v =
      verb(rig, line, "jog", "Set currents by hand, from the keyboard: step by step, largest, smallest, none",
           "  faba rig jog scenes/bench.toml --step \"20 mA\"");
  add_bench_scene(v, o->run);
  v->add_option("--step", o->step, "How far a key goes")->check(not_empty);
  v->callback([o, &line] { line.code = rig_jog(*o, line.common); });
}

}  // namespace faba::cli
