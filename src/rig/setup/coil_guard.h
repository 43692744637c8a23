#pragma once
#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/schema.h"

namespace faba {

/// Safety logic of the coils. It starts disarmed, is armed by hand, and passes currents on while commands
/// arrive in time and stay within the limits of the coils. Otherwise it sets all currents to zero and is
/// tripped (fault latched) until reset by hand, then disarmed again. It uses no clock and no device: the
/// caller passes times, s on a monotonic clock, and applies current() (guard_loop.h).
class CoilGuard {
 public:
  /// Limits of one coil.
  struct Bounds {
    double max_current = 0;  ///< A
    double max_rms = 0;      ///< A, over the thermal time
  };
  /// The table [rig.guard].
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

  enum class State : std::uint32_t { disarmed, armed, tripped };
  enum class Fault : std::uint32_t {
    none,
    not_finite,         ///< a current or frame time is not finite, or the number of currents is wrong
    over_current,       ///< a current is above the limit of its coil
    over_slew,          ///< a current changes faster than max_slew
    thermal_limit,      ///< mean square current above max_rms squared
    stale,              ///< a command was too old on arrival
    out_of_order,       ///< a command arrived twice, or after a later one
    command_timeout,    ///< no new command in time while current flows
    heartbeat_timeout,  ///< no heartbeat in time while current flows
    disconnected,       ///< the client disconnected
    signal,             ///< the guard received a signal to end
    current_mismatch,   ///< a sensed current differs from the commanded one
    device              ///< the driver reported an error
  };
  /// The currents requested for one frame.
  struct Request {
    std::uint64_t number = 0;  ///< increases with every request
    double sent = 0;           ///< s, when the program sent it
    double frame_t = 0;        ///< s, time of the frame that the command responds to: defines the slew rate
    std::span<const double> current;
  };

  /// `frame_period`, s: one command is expected per period.
  CoilGuard(const Params& p, std::vector<Bounds> coils, double frame_period);
  double command_deadline() const { return *p_.command_deadline; }  ///< s

  /// From disarmed to armed. False if tripped.
  bool arm(double now);
  void disarm(double now);
  void reset();  ///< From tripped to disarmed.
  /// A heartbeat of the program.
  void heartbeat(double now) { last_heartbeat_ = now; }
  void take(const Request& r, double now);
  /// The sensed currents, A; NaN for coils without an input.
  void sensed(std::span<const double> current, double now);
  /// Checks timeouts and thermal limits; must be called again before due().
  void check(double now);
  /// Trips: all currents are zero. The first fault is kept; `detail` is appended to its reason.
  void fail(Fault f, const std::string& detail, double now);

  /// Currents to apply now, A; zeros unless armed.
  const std::vector<double>& current() const { return current_; }
  State state() const { return state_; }
  Fault fault() const { return fault_; }
  const std::string& reason() const { return reason_; }  ///< empty unless tripped
  /// Latest time for the next check(), s; infinite while no current flows.
  double due() const;
  /// Thermal load of the warmest coil, relative to its limit.
  double heat() const;
  std::uint64_t passed() const { return passed_; }    ///< accepted requests
  std::uint64_t refused() const { return refused_; }  ///< refused requests; each trips the guard

 private:
  struct Previous {
    double t;  ///< s, until when these currents were commanded
    std::vector<double> current;
  };
  Fault violation(const Request& r, double now, std::string& detail) const;
  void update_heat(double now);
  double heat_of(std::size_t coil) const;
  std::size_t warmest() const;
  bool energised() const;
  void set_current(std::vector<double> current, double now);

  Params p_;
  std::vector<Bounds> coils_;
  double frame_period_;
  State state_ = State::disarmed;
  Fault fault_ = Fault::none;
  std::string reason_;
  std::vector<double> current_;  ///< A
  std::vector<double> heat_;     ///< A^2, of each coil: square of its current, averaged over thermal_time
  std::deque<Previous> recent_;  ///< previous commands that may still be settling, oldest first
  std::optional<std::uint64_t> last_number_;
  std::optional<double> last_frame_t_;
  double last_command_ = 0, last_heartbeat_ = 0, now_ = 0;  ///< s
  int mismatches_ = 0;                                      ///< consecutive samples with a current mismatch
  std::uint64_t passed_ = 0, refused_ = 0;
};

const char* word(CoilGuard::State s);
const char* word(CoilGuard::Fault f);

}  // namespace faba
