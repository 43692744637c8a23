#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "control/controller.h"
#include "control/plan/curve.h"
#include "core/error.h"

namespace faba {
namespace {

constexpr double kStepPx = 2;          // between points of a curve
constexpr double kLookAheadPx = 15;    // default
constexpr double kMostAhead = 0.25;    // of a lap
constexpr double kSearched = 1.0 / 3;  // of a lap: the two passes of a figure of eight are half a lap apart
constexpr std::size_t kPoints = 100;   // at least, so that the setpoints are those of a moving target

/// A setpoint that moves along a curve ahead of the swarm (pure pursuit, theory F3): it is the point
/// `look_ahead_px` further along the curve than the point nearest to the swarm, so that it waits for a slow
/// swarm. Until the swarm has come within the look-ahead distance of the start, the setpoint is the start.
class ReferencePath final : public Reference {
 public:
  enum class Shape { figure_eight, circle, text };
  struct Params {
    Shape shape = Shape::figure_eight;
    std::vector<Vec2> points_px;
    bool smooth = true, closed = false;
    std::optional<Vec2> centre_px;
    double size_px = 200;
    std::string text = "FABA";
    std::optional<double> look_ahead_px;
    int laps = 1;
  };
  static Schema<Params> schema();
  ReferencePath(const Params& p, const ControlContext& c);
  Target update(const Estimate& e) override;
  std::vector<Vec2> setpoints() const override;
  std::optional<double> path_done() const override {
    if (finished_) return 1;
    return curve_.length() > 0 ? progress_ / curve_.length() : 0;
  }
  void archive(Archive& a) override { a& progress_& started_& finished_; }

 private:
  std::vector<Vec2> curve_px(const Params& p, const Frame& frame) const;

  Curve curve_;  ///< of all laps, world frame, m
  double lap_;   ///< length of a lap, m
  double look_ahead_;
  double progress_ = 0;
  bool started_ = false, finished_ = false;
};

Schema<ReferencePath::Params> ReferencePath::schema() {
  return Schema<Params>("path", "A setpoint that moves along a curve ahead of the swarm")
      .add("shape", &Params::shape,
           {.doc = "Curve of size_px around centre_px, unless points_px are given",
            .choices = {"figure_eight", "circle", "text"}})
      .add("points_px", &Params::points_px,
           {.unit = "px",
            .min = -1e5,
            .max = 1e5,
            .doc = "Points of the curve in image coordinates, y down, instead of a shape: [[100, 120], [300, "
                   "200]]"})
      .add("smooth", &Params::smooth,
           {.doc = "A smooth curve through points_px (Catmull-Rom spline); false: straight segments"})
      .add("closed", &Params::closed, {.doc = "The curve through points_px returns to its first point"})
      .add("centre_px", &Params::centre_px,
           {.unit = "px",
            .min = -1e5,
            .max = 1e5,
            .doc = "Centre of the shape in image coordinates; default: the centre of the arena"})
      .add("size_px", &Params::size_px, {.unit = "px", .min = 1, .max = 1e5, .doc = "Width of the shape"})
      .add("text", &Params::text, {.doc = "Text that is written: letters, digits, spaces and hyphens"})
      .add("look_ahead_px", &Params::look_ahead_px,
           {.unit = "px",
            .min = 0.1,
            .max = 1e4,
            .doc = "Distance along the curve from the point nearest to the swarm to the setpoint, at most a "
                   "quarter of the curve; a longer one is faster and cuts corners; default: 15 px",
            .source = "assumed",
            .title = "Look-ahead distance"})
      .add("laps", &Params::laps,
           {.min = 1, .max = 1000, .doc = "Times that the curve is followed; more than 1: back to its start"})
      .check([](const Params& p) -> std::string {
        if (p.points_px.size() == 1)
          return "points_px has 1 point; a curve needs at least two points, such as [[100, 120], [300, 200]]";
        if (p.shape == Shape::text && text_outline(p.text, {}, 1).size() < 2)
          return "text \"" + p.text + "\" has no letter or digit; write a text such as \"FABA\"";
        return "";
      })
      .check([](const Params& p) -> std::string {
        const auto wrong = std::find_if(p.text.begin(), p.text.end(), [](char c) {
          return text_outline(std::string{c}, {}, 1).empty() && c != ' ';
        });
        return p.shape == Shape::text && wrong != p.text.end()
                   ? "text \"" + p.text + "\" contains a character that cannot be written; use " +
                         std::string(kOutlineCharacters.substr(0, 36)) + ", spaces and hyphens"
                   : "";
      })
      .validity(
          "The setpoint follows the mean of the swarm. A swarm cuts corners that are sharper than its "
          "look-ahead distance.");
}

namespace {

std::vector<Vec2> in_world(const std::vector<Vec2>& image, const Frame& frame, int laps) {
  std::vector<Vec2> out;
  for (int lap = 0; lap < laps; ++lap)
    for (const Vec2 p : image) out.push_back(frame.world_from_image(p));
  return out;
}

}  // namespace

std::vector<Vec2> ReferencePath::curve_px(const Params& p, const Frame& frame) const {
  const Vec2 centre = p.centre_px.value_or(frame.centre_image);
  if (!p.points_px.empty()) {
    if (p.smooth) return spline_through(p.points_px, p.closed, kStepPx);
    std::vector<Vec2> all = p.points_px;
    if (p.closed) all.push_back(all.front());
    return all;
  }
  switch (p.shape) {
    case Shape::figure_eight:
      return figure_eight(centre, p.size_px, kStepPx);
    case Shape::circle:
      return circle(centre, p.size_px, kStepPx);
    case Shape::text:
      return text_outline(p.text, centre, p.size_px);
  }
  return {};
}

ReferencePath::ReferencePath(const Params& p, const ControlContext& c)
    : curve_(in_world(curve_px(p, c.frame), c.frame, p.laps)),
      lap_(Curve(in_world(curve_px(p, c.frame), c.frame, 1)).length()),
      look_ahead_(std::min(p.look_ahead_px.value_or(kLookAheadPx) * c.scale.m_per_px, kMostAhead * lap_)) {
  if (!(lap_ > 0))
    throw Error(Errc::usage, "reference.points_px",
                "all points are equal; a curve needs at least two different points");
  const double most = kMostAhead * lap_ / c.scale.m_per_px;
  if (p.look_ahead_px.value_or(0) > most)
    throw Error(Errc::usage, "reference.look_ahead_px",
                fmt::format("{:g} px is too long for a curve of {:.4g} px; it must be at most {:.4g} px, a "
                            "quarter of the curve; reduce it, or enlarge the curve",
                            *p.look_ahead_px, lap_ / c.scale.m_per_px, most));
}

Target ReferencePath::update(const Estimate& e) {
  if (e.visible > 0 && std::isfinite(norm(e.centroid))) {
    started_ = started_ || norm(e.centroid - curve_.points().front()) <= look_ahead_;
    // Only the next part is searched: a curve that crosses itself, or returns to its start, is followed in
    // its order.
    const double part = std::min(3 * look_ahead_, kSearched * lap_);
    if (started_) progress_ = curve_.nearest(e.centroid, progress_, progress_ + part);
    finished_ = started_ && curve_.length() - progress_ <= look_ahead_ / 2;
  }
  const double s = started_ ? progress_ + look_ahead_ : 0;
  return {curve_.at(s), 0, finished_};
}

std::vector<Vec2> ReferencePath::setpoints() const {
  const auto n = std::max(kPoints, curve_.points().size());
  std::vector<Vec2> out;
  for (std::size_t i = 0; i < n; ++i) out.push_back(curve_.at(lap_ * double(i) / double(n - 1)));
  return out;
}

}  // namespace

void add_path(ReferenceRegistry& r) { r.add<ReferencePath>(); }

}  // namespace faba
