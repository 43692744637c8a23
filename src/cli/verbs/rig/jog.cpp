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

#include "app/bench/bench_controls.h"
#include "app/bench/coil_jog.h"
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

constexpr double kCycle = CoilJog::kCycle;
constexpr double kPipedKey = 0.1;  // minimum s between keys that do not come from a terminal

void print_keys(std::size_t coils) {
  fmt::print(
      "{}    up + down -  one step    page up, page down  maximum, minimum    0  zero\n"
      "a  arm    space  all currents zero    r  reset a fault    q  quit\n",
      coils > 1 ? fmt::format("keys 1 to {} select coils 0 to {}", std::min<std::size_t>(coils, 9),
                              std::min<std::size_t>(coils, 9) - 1)
                : "coil 0");
}

// Reads single keys without waiting for the end of a line.
class Keyboard {
 public:
  Keyboard() : terminal_(isatty(STDIN_FILENO) != 0) {
    if (!terminal_) return;
    tcgetattr(STDIN_FILENO, &before_);
    termios raw = before_;
    raw.c_lflag &= ~tcflag_t(ICANON | ECHO);  // Ctrl-C still sends a signal
    raw.c_cc[VMIN] = 0;
    raw.c_cc[VTIME] = 0;
    tcsetattr(STDIN_FILENO, TCSANOW, &raw);
  }
  ~Keyboard() {
    if (terminal_) tcsetattr(STDIN_FILENO, TCSANOW, &before_);
  }
  Keyboard(const Keyboard&) = delete;
  Keyboard& operator=(const Keyboard&) = delete;

  /// The next key within kCycle: a character, or 'U', 'D', 'P', 'N' for up, down, page up and page down. 0:
  /// no key; 'q' at the end of the input.
  char next() {
    pollfd ready{STDIN_FILENO, POLLIN, 0};
    if (!terminal_ && monotonic_now() < next_key_time_) {
      wait_one_cycle();
      return 0;
    }
    if (poll(&ready, 1, int(1e3 * kCycle)) <= 0) return 0;
    const char key = get();
    next_key_time_ = monotonic_now() + kPipedKey;
    if (key != '\033') return key;
    if (get() != '[') return 0;
    const char what = get();
    if (what == '5' || what == '6') get();  // a ~ follows
    return what == 'A' ? 'U' : what == 'B' ? 'D' : what == '5' ? 'P' : what == '6' ? 'N' : '\0';
  }
  bool terminal() const { return terminal_; }

 private:
  static void wait_one_cycle() { poll(nullptr, 0, int(1e3 * kCycle)); }
  static char get() {
    char c = 0;
    return read(STDIN_FILENO, &c, 1) == 1 ? c : 'q';
  }
  termios before_{};
  bool terminal_;
  double next_key_time_ = 0;  ///< s
};

// Cuts a text to one line of the terminal.
std::string cut_to_terminal(std::string line) {
  winsize size{};
  if (ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 1 && line.size() >= size.ws_col)
    line.resize(size.ws_col - 1U);
  return line;
}

std::string line_of(const GuardReport& g, const std::vector<double>& requested, std::size_t selected) {
  if (g.state == CoilGuard::State::tripped)
    return fmt::format("tripped  {}{}; press r to reset", g.reason.data(),
                       g.write_ok ? "" : "; the coils could not be de-energised: switch them off manually");
  std::string line = fmt::format("{:<8}", word(g.state));
  for (std::size_t k = 0; k < requested.size(); ++k) {
    line += fmt::format(" {}coil {}: {:+.3f} A", k == selected ? "[" : " ", k, requested[k]);
    if (!std::isnan(g.sensed[k])) line += fmt::format(", sensed {:+.3f}", g.sensed[k]);
    line += k == selected ? "]" : " ";
  }
  if (g.reason[0])
    line += fmt::format("  {}", g.reason.data());
  else if (g.state == CoilGuard::State::disarmed)
    line += "  press a to arm";
  return line;
}

int rig_jog(const JogVerb& v, const Common& c) {
  Scenario s = read_bench_scene(v.run);
  const double step = quantity_of(v.step, "A", "--step", "50 mA");
  if (!(step > 0))
    throw Error(Errc::usage, "--step", fmt::format("{:g} A is out of range; it must be positive", step));
  if (const double largest = std::ranges::max(permitted_currents(s)); step > largest)
    throw Error(Errc::usage, "--step",
                fmt::format("{:g} A is out of range; the maximum of the coils of this bench is {:g} A", step,
                            largest));
  const OpenBench bench(s, s.params.seed.value_or(1), OpenBench::Open::coils);
  GuardLink coils(bench.guard_setup({}));
  CoilJog jog(coils, s);
  std::size_t selected = 0;
  std::string shown;
  Keyboard keys;
  const bool verbose = !c.quiet && !c.json;
  if (verbose) print_keys(jog.coils());
  while (!stop_requested().load()) {
    const char key = keys.next();
    if (key == 'q') break;
    if (key >= '1' && key <= '9' && std::size_t(key - '1') < jog.coils()) selected = std::size_t(key - '1');
    const double value = jog.requested(selected), limit = jog.limit(selected);
    if (key == 'U' || key == '+') jog.request(selected, value + step);
    if (key == 'D' || key == '-') jog.request(selected, value - step);
    if (key == 'P') jog.request(selected, limit);
    if (key == 'N') jog.request(selected, -limit);
    if (key == '0') jog.request(selected, 0);
    if (key == ' ') jog.all_zero();
    const CoilGuard::State state = coils.report().state;
    if (key == 'r' && state == CoilGuard::State::tripped) jog.reset();
    if (key == 'a' && state == CoilGuard::State::disarmed) jog.arm();
    const GuardReport report = jog.step();
    const std::string line = line_of(report, jog.requested(), selected);
    if (line == shown || !verbose) continue;
    fmt::print("{}{}{}", keys.terminal() ? "\r\033[K" : "", keys.terminal() ? cut_to_terminal(line) : line,
               keys.terminal() ? "" : "\n");
    std::fflush(stdout);
    shown = line;
  }
  if (keys.terminal() && verbose) fmt::print("\n");
  jog.disarm();
  const GuardReport g = coils.report();
  if (c.json) fmt::print("{}\n", Json{{"state", word(g.state)}, {"reason", g.reason.data()}}.dump());
  if (stop_requested().load()) return int(Errc::interrupted);
  return g.state == CoilGuard::State::tripped ? int(Errc::device) : 0;
}

}  // namespace

void add_rig_jog(CLI::App& rig, CommandLine& line) {
  const auto o = std::make_shared<JogVerb>();
  CLI::App* v = verb(rig, line, "jog", "Set coil currents manually from the keyboard",
                     "  faba rig jog scenes/bench.toml --step \"20 mA\"");
  add_bench_scene(v, o->run);
  v->add_option("--step", o->step, "Change of the current per key; default: \"" + o->step + '"')
      ->check(not_empty);
  v->callback([o, &line] { line.code = rig_jog(*o, line.common); });
}

}  // namespace faba::cli
