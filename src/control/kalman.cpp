#include <algorithm>
#include <cmath>

#include "control/centroid.h"
#include "control/plant/mean_filter.h"

namespace faba {
namespace {

/// The estimator whose positions are filtered: any estimator that was registered before.
struct Source {
  EstimatorRegistry::PartType part;

  struct Description {
    const EstimatorRegistry& known;
    Source parse(const Node& n) const { return {known.resolve(n)}; }
    Json to_json(const Source& s) const { return s.part.resolved; }
    Json json_schema() const { return known.json_schema_of_choice(); }
  };
  static Description schema(const void* known) { return {*static_cast<const EstimatorRegistry*>(known)}; }
};

/// Kalman filter over another estimator (theory F4): position, drift velocity, relative speed and drift of
/// the medium. A picture gives the position at the time of its exposure; the filter knows the commands since
/// then and predicts to the time at which the next command acts. It predicts for `coast` while no cell is
/// seen, adapts to a swarm that becomes slower, and ignores positions that it does not expect.
class EstimatorKalman final : public Estimator {
 public:
  struct Params {
    std::optional<Source> source;
    MotionParams motion;
    double coast = 0.25;
    double noise_px = 0.1;

    std::vector<Trait> traits() const { return source ? source->part.traits : std::vector<Trait>{}; }
  };
  static Schema<Params> schema(const std::shared_ptr<const EstimatorRegistry>& known);
  EstimatorKalman(const Params& p, const ControlContext& c, std::shared_ptr<const EstimatorRegistry> known);
  Estimate update(const Observation& o, const Command& last) override;
  void archive(Archive& a) override;

 private:
  /// A field that acts from a time until the next one.
  struct Acting {
    double since = 0;  ///< s
    Vec2 along;        ///< T, times the polarity
    void archive(Archive& a) { a& since& along; }
  };
  void choose_source(bool pictures);
  Mat2 error_of(const Estimate& seen) const;
  void advance_to(double t);
  void measure(const Estimate& seen);
  Estimate predicted(const Observation& o, const Estimate& seen) const;
  template <class Advance>
  void for_pieces(double from, double to, const Advance& advance) const;

  Params p_;
  ControlContext c_;
  std::shared_ptr<const EstimatorRegistry> known_;
  std::unique_ptr<Estimator> source_;
  bool pictures_ = false;  ///< the default source is that of pictures
  MeanFilter filter_;
  std::vector<Acting> acting_;  ///< in order of time, from the one that acts at filter_t_
  double lag_ = 0;              ///< of the coils, s
  double filter_t_ = 0;         ///< time of the filter's belief, s
  double act_t_ = 0;            ///< time at which the last command acted, s
  double seen_t_ = 0;           ///< time of the last measurement that was taken, s
  double cells_ = 0, most_cells_ = 0;
  Mat2 seen_cov_;  ///< of the cells in the last measurement, m^2
};

Schema<EstimatorKalman::Params> EstimatorKalman::schema(
    const std::shared_ptr<const EstimatorRegistry>& known) {
  return Schema<Params>("kalman", "Kalman filter: predicts the swarm to the time at which the command acts")
      .add("source", &Params::source,
           {.doc = "Estimator whose positions are filtered; default: `visible` if the positions of the cells "
                   "are known, `image` if there are pictures",
            .context = known})
      .include(&Params::motion, MotionParams::schema())
      .add("coast", &Params::coast,
           {.unit = "s",
            .min = 0,
            .max = 1e3,
            .doc = "Time for which the swarm is predicted, and steered, while no cell is seen",
            .source = "assumed",
            .title = "Time without cells"})
      .add("noise_px", &Params::noise_px,
           {.unit = "px",
            .min = 1e-6,
            .max = 1e3,
            .doc =
                "Standard deviation of the error of a position when all cells are seen; the filter adapts it",
            .source = "assumed",
            .title = "Error of a position"})
      .validity(
          "The plant is that of one swarm in a field that is nearly uniform over it. Walls are not modelled: "
          "at "
          "the edge of a drop the filter adapts as to a slower swarm.");
}

EstimatorKalman::EstimatorKalman(const Params& p, const ControlContext& c,
                                 std::shared_ptr<const EstimatorRegistry> known)
    : p_(p), c_(c), known_(std::move(known)), filter_(p.motion.of(c.motion), {}) {
  if (p_.source) source_ = p_.source->part.make(c_);
  for (std::size_t k = 0; k < c.field->coils(); ++k) lag_ = std::max(lag_, c.field->circuit(k).lag);
}

void EstimatorKalman::choose_source(bool pictures) {
  pictures_ = pictures;
  const Json name = pictures ? "image" : "visible";
  source_ = known_->resolve(Node{name, "estimator.source", nullptr}).make(c_);
}

// Covariance of the errors that differ from frame to frame. When cells have left the view, the mean of the
// others has moved by up to a standard deviation of the swarm.
Mat2 EstimatorKalman::error_of(const Estimate& seen) const {
  const double noise = p_.noise_px * c_.scale.m_per_px;
  const double lost = most_cells_ > 0 ? std::max(0.0, 1 - seen.visible / most_cells_) : 0.0;
  const Mat2 flicker = flicker_cov(filter_.started() ? seen_cov_ : seen.cov, seen.cov, seen.visible);
  return Mat2{noise * noise, 0, noise * noise} + lost * lost * seen.cov + flicker;
}

template <class Advance>
void EstimatorKalman::for_pieces(double from, double to, const Advance& advance) const {
  for (std::size_t i = 0; i < acting_.size(); ++i) {
    const double begin = i == 0 ? from : std::max(from, acting_[i].since);
    const double end = i + 1 < acting_.size() ? std::min(to, acting_[i + 1].since) : to;
    if (end > begin) advance(acting_[i].along, end - begin);
  }
}

void EstimatorKalman::advance_to(double t) {
  for_pieces(filter_t_, t, [&](Vec2 along, double time) { filter_.advance(along, time, cells_); });
  filter_t_ = std::max(filter_t_, t);
  while (acting_.size() > 1 && acting_[1].since <= filter_t_) acting_.erase(acting_.begin());
}

void EstimatorKalman::measure(const Estimate& seen) {
  if (!(seen.visible > 0) || !std::isfinite(norm(seen.centroid))) return;
  cells_ = seen.visible;
  most_cells_ = std::max(most_cells_, seen.visible);
  const Mat2 error = error_of(seen);
  seen_cov_ = seen.cov;
  if (!filter_.started()) filter_t_ = seen.t;
  if (filter_.measure(seen.centroid, error)) seen_t_ = seen.t;
}

Estimate EstimatorKalman::predicted(const Observation& o, const Estimate& seen) const {
  Estimate e = seen;
  e.predicted = true;
  e.t = act_t_;
  if (!filter_.started()) return e;
  MeanBelief b = filter_.belief();
  for_pieces(filter_t_, act_t_, [&](Vec2 along, double time) { filter_.advance(b, along, time, cells_); });
  e.centroid = b.position();
  e.velocity = b.velocity();
  e.centroid_cov = b.position_cov() + seen.centroid_cov;
  e.velocity_cov = b.velocity_cov();
  if (!(e.visible > 0) && o.t - seen_t_ <= p_.coast) e.visible = cells_;
  return e;
}

Estimate EstimatorKalman::update(const Observation& o, const Command& last) {
  if (!source_) choose_source(o.image != nullptr);
  const Vec2 at = filter_.started() ? filter_.belief().position() : Vec2{};
  // The last command acts since the time that was predicted for it, and the coils follow it with their lag.
  acting_.push_back({act_t_ + lag_, field_along(c_, at, last)});
  act_t_ = std::max(act_t_, o.t + o.age);
  if (!filter_.started()) filter_t_ = o.t;
  const Estimate seen = source_->update(o, last);
  if (filter_.started()) advance_to(o.t);
  measure(seen);
  return predicted(o, seen);
}

void EstimatorKalman::archive(Archive& a) {
  bool chosen = source_ != nullptr;
  a& chosen& pictures_;
  if (chosen && !source_) choose_source(pictures_);
  if (source_) source_->archive(a);
  a& filter_& acting_& filter_t_& act_t_& seen_t_& cells_& most_cells_& seen_cov_.xx& seen_cov_.xy& seen_cov_
      .yy;
}

}  // namespace

// Registered after the estimators that it can have as its source.
void add_kalman(EstimatorRegistry& r) {
  const auto known = std::make_shared<const EstimatorRegistry>(r);
  r.add_made<EstimatorKalman::Params>(EstimatorKalman::schema(known), {},
                                      [known](const EstimatorKalman::Params& p, const ControlContext& c) {
                                        return std::make_unique<EstimatorKalman>(p, c, known);
                                      });
}

}  // namespace faba
