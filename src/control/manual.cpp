#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "control/controller.h"
#include "core/counted.h"
#include "core/portable_math.h"
#include "core/schema.h"
#include "field/allocate.h"

namespace faba {
namespace {

/// A schedule of field vectors, independent of the swarm: constant fields, reversals (the step response,
/// theory A14), rotating fields with or without bias (B3.6-B3.8).
///   B(t) = field + rotating (cos 2 pi f (t - at), sin 2 pi f (t - at))
class Manual final : public Controller {
 public:
  struct Segment {
    double at = 0;
    Vec2 field;
    double rotating = 0;
    double frequency = 0;
    std::vector<double> current;
    static Schema<Segment> schema();
  };
  struct Params {
    Vec2 field;
    std::vector<double> current;
    std::vector<Segment> segment;
  };
  static constexpr std::array kTraits = {Trait::open_loop};
  static Schema<Params> schema();
  Manual(const Params& p, const ControlContext& c);
  Command update(const Estimate& e, const Target& target, double dt) override;
  void archive(Archive& a) override { a& t_& started_; }
  double max_field() const override;
  std::vector<std::vector<double>> given_currents() const override;

  /// The segment active at time t; null before the first.
  const Segment* segment_at(double t) const;
  /// The scheduled field at time t, T, world frame.
  Vec2 field_at(double t) const;

 private:
  Params p_;
  ControlContext c_;
  double t_ = 0;  ///< s since the first frame, in control time; independent of the camera delay
  bool started_ = false;
};

FieldInfo currents_info() {
  return {.unit = "A",
          .min = -1e4,
          .max = 1e4,
          .doc = "Coil currents, one per coil, instead of a field: for opposed coils"};
}

Schema<Manual::Segment> Manual::Segment::schema() {
  return Schema<Segment>("segment", "A field segment")
      .add("at", &Segment::at, {.unit = "s", .min = 0, .max = 1e7, .doc = "Start time of the segment"})
      .add("field", &Segment::field,
           {.unit = "T", .min = -0.1, .max = 0.1, .doc = "Constant part, world frame: x right, y up"})
      .add("rotating", &Segment::rotating,
           {.unit = "T", .min = 0, .max = 0.1, .doc = "Magnitude of a rotating part"})
      .add("frequency", &Segment::frequency,
           {.unit = "Hz", .min = -1000, .max = 1000, .doc = "Rotation frequency, counterclockwise positive"})
      .add("current", &Segment::current, currents_info());
}

Schema<Manual::Params> Manual::schema() {
  return Schema<Params>("manual", "A schedule of field vectors, independent of the swarm")
      .add("field", &Params::field,
           {.unit = "T",
            .min = -0.1,
            .max = 0.1,
            .doc = "Field before the first segment, world frame: x right, y up"})
      .add("current", &Params::current, currents_info())
      .add("segment", &Params::segment, {.doc = "Field segments by ascending time: [[controller.segment]]"})
      .check([](const Params& p) -> std::string {
        for (std::size_t i = 1; i < p.segment.size(); ++i)
          if (p.segment[i].at <= p.segment[i - 1].at)
            return fmt::format(
                "segments must be in ascending order of `at`; segment[{}].at = {:g} s is not later than "
                "segment[{}].at = {:g} s",
                i, p.segment[i].at, i - 1, p.segment[i - 1].at);
        return {};
      })
      .validity(
          "The field is set once per frame: a rotating field needs a frame rate well above its frequency.");
}

Manual::Manual(const Params& p, const ControlContext& c) : p_(p), c_(c) {
  const auto check = [&](const std::vector<double>& current) {
    if (!current.empty() && current.size() != c.field->coils())
      throw Error(Errc::usage, "controller.current",
                  fmt::format("has {}; it must have {}, one per coil", counted(current.size(), "value"),
                              c.field->coils()));
  };
  check(p.current);
  for (const Segment& s : p.segment) check(s.current);
}

const Manual::Segment* Manual::segment_at(double t) const {
  // Times are sums of frame periods: the tolerance of 1e-6 frames absorbs rounding.
  const double now = t + 1e-6 * c_.frame_period;
  const Segment* s = nullptr;
  for (const Segment& candidate : p_.segment)
    if (candidate.at <= now) s = &candidate;
  return s;
}

Vec2 Manual::field_at(double t) const {
  const Segment* s = segment_at(t);
  if (!s) return p_.field;
  const auto turn = portable::sincos(2 * portable::kPi * s->frequency * (t - s->at));
  return {s->field.x + s->rotating * turn.cos, s->field.y + s->rotating * turn.sin};
}

double Manual::max_field() const {
  double most = p_.current.empty() && !segment_at(0) ? norm(p_.field) : 0;
  for (const Segment& s : p_.segment)
    if (s.current.empty()) most = std::max(most, norm(s.field) + s.rotating);
  return most;
}

std::vector<std::vector<double>> Manual::given_currents() const {
  std::vector<std::vector<double>> all;
  if (!p_.current.empty() && !segment_at(0)) all.push_back(p_.current);
  for (const Segment& s : p_.segment)
    if (!s.current.empty()) all.push_back(s.current);
  return all;
}

Command Manual::update(const Estimate& e, const Target&, double dt) {
  if (started_) t_ += dt;
  started_ = true;
  const Segment* s = segment_at(t_);
  if (const auto& current = s ? s->current : p_.current; !current.empty()) return {current};
  // The estimator `none` gives no position: the field is then that at the centre of the arena.
  const Vec2 at = std::isfinite(norm(e.centroid)) ? e.centroid : Vec2{};
  return {allocate(*c_.field, {at.x, at.y, 0}, field_at(t_))};
}

}  // namespace

void add_manual(ControllerRegistry& r) { r.add<Manual>(); }

}  // namespace faba
