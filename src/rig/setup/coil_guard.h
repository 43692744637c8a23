#pragma once
#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/schema.h"

namespace faba {

/// The last word on what the coils get. It begins disarmed, is armed by hand, and passes currents on while
/// they come in time and stay within what the coils bear. At anything else all currents go to zero and it is
/// faulted until reset by hand, after which it is disarmed again. It knows no clock and no device: times are
/// handed in, s on one clock that never goes back, and what it says is carried out by others (guard_loop.h).
class CoilGuard {
 public:
  /// What one coil bears.
  struct Bounds {
    double max_current = 0;  ///< A
    double max_rms = 0;      ///< A, over the thermal time
  };
  /// Of [rig.guard].
  struct Params {
    std::optional<double> command_deadline = {};  ///< s
    double heartbeat_deadline = 0.07;             ///< s
    std::optional<double> max_slew = {};          ///< A/s
    double thermal_time = 60;                     ///< s
    double sense_tolerance = 0.05;                ///< A
    double sense_settling = 0.1;                  ///< s
    int sense_samples = 5;
  };
  static Schema<Params> schema();

  enum class State : std::uint32_t { disarmed, armed, faulted };
  enum class Fault : std::uint32_t {
    none,
    not_finite,    ///< a current is not a number
    over_current,  ///< one is larger than the coil bears
    over_slew,     ///< one changes faster than allowed
    too_warm,      ///< a coil has had its heat
    stale,         ///< a command was too old when it came
    disorder,      ///< a command came twice, or after a later one
    late,          ///< no fresh command in time, while current was asked for
    silent,        ///< the program gave no sign of life in time, while current was asked for
    closed,        ///< the program is gone
    signal,        ///< the guard was told to end
    sensed,        ///< a coil's current is not what was asked for
    device         ///< the driver reported an error
  };
  /// The currents asked for, as of one frame.
  struct Request {
    std::uint64_t number = 0;  ///< rises with every request
    double sent = 0;           ///< s, when the program sent it
    double frame_t = 0;        ///< s, of the frame that it answers: slew is reckoned by these
    std::span<const double> current;
  };

  /// `frame_period`, s: a command is expected in each.
  CoilGuard(const Params& p, std::vector<Bounds> coils, double frame_period);
  double command_deadline() const { return *p_.command_deadline; }  ///< s

  /// From disarmed to armed; what is asked for then counts. False when faulted.
  bool arm(double now);
  void disarm(double now);
  void reset();  ///< From faulted to disarmed.
  /// A sign of life of the program.
  void beat(double now) { beat_ = now; }
  void take(const Request& r, double now);
  /// The currents as the inputs tell them, A; not a number where nothing is told.
  void sensed(std::span<const double> current, double now);
  /// Looks at deadlines and heat; to be called before due().
  void look(double now);
  /// Zero from now on; the first reason stays. `detail` is added to it in words.
  void fail(Fault f, const std::string& detail, double now);

  /// What the coils shall get now, A; zeros unless armed.
  const std::vector<double>& current() const { return current_; }
  State state() const { return state_; }
  Fault fault() const { return fault_; }
  const std::string& reason() const { return reason_; }  ///< in a sentence; empty unless faulted
  /// When look() is to be called at the latest, s; infinite while nothing flows.
  double due() const;
  /// Heat of the warmest coil, 1 at its bound.
  double heat() const;
  std::uint64_t passed() const { return passed_; }    ///< requests that went through
  std::uint64_t refused() const { return refused_; }  ///< and that did not, a fault each unless disarmed

 private:
  struct Passed {
    double t;  ///< s, since when
    std::vector<double> current;
  };
  Fault objection(const Request& r, double now, std::string& detail) const;
  void warm(double now);
  double heat_of(std::size_t coil) const;
  std::size_t warmest() const;
  bool flows() const;
  void put(std::vector<double> current, double now);

  Params p_;
  std::vector<Bounds> coils_;
  double frame_period_;
  State state_ = State::disarmed;
  Fault fault_ = Fault::none;
  std::string reason_;
  std::vector<double> current_;  ///< A
  std::vector<double> heat_;     ///< A^2, of each coil: its square current, averaged over thermal_time
  std::deque<Passed> lately_;    ///< what the coils may still have by now, oldest first
  std::optional<std::uint64_t> last_number_;
  std::optional<double> last_frame_t_;
  double fresh_ = 0, beat_ = 0, now_ = 0;  ///< s
  int off_ = 0;                            ///< samples in a row that told another current
  std::uint64_t passed_ = 0, refused_ = 0;
};

const char* word(CoilGuard::State s);
const char* word(CoilGuard::Fault f);

}  // namespace faba
