#include <algorithm>
#include <cmath>
#include <optional>

#include "control/centroid.h"
#include "control/controller.h"
#include "control/foreground_params.h"
#include "vision/foreground/fuzzy_groups.h"

namespace faba {
namespace {

constexpr int kBins = 32;         // per axis, for clustering: a thousand bins replace a million cells
constexpr double kLarger = 1.25;  // size relative to the followed group at which another group is followed

/// Several swarms: the cells in view, or the foreground of the camera frame when no positions are available,
/// clustered by fuzzy c-means (vision/foreground/fuzzy_groups.h). The estimate is that of one group.
class EstimatorGroups final : public Estimator {
 public:
  enum class Follow { largest, first };
  struct Params {
    ForegroundParams foreground;
    int count = 0, most = 4;
    double separation = 4.5;
    Follow follow = Follow::largest;
    std::optional<Vec2> near;
  };
  static Schema<Params> schema() {
    return Schema<Params>("groups", "Several swarms by fuzzy clustering; one of them is steered")
        .add("count", &Params::count,
             {.min = 0, .max = 10, .doc = "Number of groups; 0: determined in every frame", .source = "H6"})
        .add("most", &Params::most,
             {.min = 1,
              .max = 10,
              .doc = "Maximum number of groups when count is 0",
              .source = "assumed",
              .title = "Maximum number of groups"})
        .add("separation", &Params::separation,
             {.min = 1,
              .max = 100,
              .doc = "Minimum distance between two groups, relative to their dispersion along the line "
                     "between them",
              .source = "H6"})
        .add("follow", &Params::follow,
             {.doc =
                  "Group used for the estimate: largest: the largest group, replaced when another is 25 % "
                  "larger; first: always the group that is largest, or nearest to `near`, in the first frame",
              .choices = {"largest", "first"}})
        .add("near", &Params::near,
             {.unit = "m",
              .min = -1,
              .max = 1,
              .doc = "Initial position of the group to follow with follow = \"first\", world frame"})
        .include(&Params::foreground, foreground_schema("", ""))
        .validity(
            "Groups whose distance is below `separation` times their dispersion are merged. Single cells and "
            "groups of a few cells are ignored.");
  }
  EstimatorGroups(const Params& p, const ControlContext& c)
      : p_(p), frame_(c.frame), foreground_(p.foreground.options()) {}

  Estimate update(const Observation& o, const Command&) override {
    double cells = 0;
    const std::vector<WeightedPosition> positions =
        o.seen.empty() && o.image ? from_picture(o, cells) : from_cells(o, cells);
    FuzzyGroupOptions options;
    options.count = p_.count;
    options.most = p_.most;
    options.separation = p_.separation;
    const std::vector<FuzzyGroup> groups = fuzzy_groups(positions, options);
    Estimate e;
    e.t = o.t;
    e.centroid = at_;
    if (groups.empty()) return e;
    const FuzzyGroup& followed = groups[followed_group(groups)];
    e.centroid = followed.centroid;
    e.cov = followed.cov;
    e.visible = cells * followed.share;
    if (o.seen.empty()) e.centroid_cov = sample_cov(e.cov, e.visible);
    if (has_estimate_ && o.t > t_) e.velocity = (1 / (o.t - t_)) * (e.centroid - at_);
    at_ = e.centroid;
    t_ = o.t;
    has_estimate_ = true;
    for (const FuzzyGroup& g : groups) e.groups.push_back({g.centroid, g.share, g.cov});
    return e;
  }
  void archive(Archive& a) override { a& foreground_& at_& t_& frame_t_& has_estimate_& has_frame_; }

 private:
  std::vector<WeightedPosition> from_cells(const Observation& o, double& cells) {
    positions_.clear();
    for (const Detection& d : o.seen)
      if (d.in_view && std::isfinite(d.x) && std::isfinite(d.y))
        positions_.push_back({{double(d.x), double(d.y)}, 1});
    cells = double(positions_.size());
    return positions_.size() > 2000 ? binned(positions_, kBins) : positions_;
  }
  std::vector<WeightedPosition> from_picture(const Observation& o, double& cells) {
    foreground_.take(camera_picture(o, frame_), has_frame_ ? o.t - frame_t_ : 0);
    frame_t_ = o.t;
    has_frame_ = true;
    cells = foreground_.moments().cells;
    positions_.clear();
    if (cells == 0) return {};
    add_pieces(foreground_.weights(), foreground_.runs());
    return binned(positions_, kBins);
  }
  // Splits rows of pixels into pieces of a quarter of a bin, so that the loss of dispersion is small compared
  // with that of the bins.
  void add_pieces(const GrayF& weights, const std::vector<ComponentRun>& runs) {
    int low = weights.width, high = 0;
    for (const ComponentRun& r : runs) {
      low = std::min(low, r.first);
      high = std::max(high, r.end);
    }
    if (!runs.empty()) high = low + std::max(high - low, runs.back().row - runs.front().row);
    const int piece = std::max(1, (high - low) / (4 * kBins));
    for (const ComponentRun& r : runs) {
      const float* weight = &weights.px[std::size_t(r.row) * std::size_t(weights.width)];
      for (int i = r.first; i < r.end;) {
        const int stop = std::min(r.end, i + piece);
        double sum = 0, x = 0;
        for (; i < stop; ++i)
          if (weight[i] > 0) {
            sum += double(weight[i]);
            x += double(weight[i]) * i;
          }
        if (sum > 0) positions_.push_back({frame_.world_from_image({x / sum, double(r.row)}), sum});
      }
    }
  }
  std::size_t followed_group(const std::vector<FuzzyGroup>& groups) const {
    if (!has_estimate_ && (!p_.near || p_.follow == Follow::largest)) return 0;
    const Vec2 from = has_estimate_ ? at_ : *p_.near;
    std::size_t nearest = 0;
    for (std::size_t k = 1; k < groups.size(); ++k)
      if (norm(groups[k].centroid - from) < norm(groups[nearest].centroid - from)) nearest = k;
    const bool stay = p_.follow == Follow::first || groups[0].share < kLarger * groups[nearest].share;
    return stay ? nearest : 0;
  }

  Params p_;
  Frame frame_;
  Foreground foreground_;
  std::vector<WeightedPosition> positions_;  ///< scratch buffer, reused
  Vec2 at_;                                  ///< last centroid, m, world
  double t_ = 0, frame_t_ = 0;
  bool has_estimate_ = false, has_frame_ = false;
};

}  // namespace

void add_groups(EstimatorRegistry& r) { r.add<EstimatorGroups>(); }

}  // namespace faba
