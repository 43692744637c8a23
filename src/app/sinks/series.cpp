#include <fmt/format.h>

#include <cmath>

#include "app/sinks/sinks.h"
#include "core/file.h"

namespace faba {
namespace {

class Series final : public RunSink {
 public:
  Series(const SinkContext& c, std::uint64_t keep) : c_(c), file_(c.dir / "series.csv", keep) {
    if (keep == 0) file_.append(header());
  }

  void take(const Tick& t) override {
    const State& s = c_.world->state();
    const auto x = s.agents["x"], y = s.agents["y"];
    const auto n = double(x.size());
    double sx = 0, sy = 0, visible = 0;
    for (std::size_t i = 0; i < x.size(); ++i) {
      sx += double(x[i]), sy += double(y[i]);
      visible += c_.frame.in_view(c_.frame.image_from_world({double(x[i]), double(y[i])}));
    }
    const Vec2 mean{sx / n, sy / n};
    double xx = 0, yy = 0;
    for (std::size_t i = 0; i < x.size(); ++i) {
      const double dx = double(x[i]) - mean.x, dy = double(y[i]) - mean.y;
      xx += dx * dx, yy += dy * dy;
    }
    const double px = 1 / c_.scale.m_per_px, divisor = n > 1 ? n - 1 : 1;
    const double sigma_x = std::sqrt(xx / divisor) * px, sigma_y = std::sqrt(yy / divisor) * px;
    const Vec2 at = c_.frame.image_from_world(mean), to = c_.frame.image_from_world(t.target.position);
    const Vec2 believed = c_.frame.image_from_world(t.estimate.centroid);
    const Vec3 b = c_.world->parts().field->at({mean.x, mean.y, 0}, s.current);
    std::string line = fmt::format("{},{:.9g}", t.index, c_.time_of(t.index));
    for (const double v :
         {at.x, at.y, sigma_x, sigma_y, std::sqrt(sigma_x * sigma_x + sigma_y * sigma_y), norm(at - to)})
      line += cell(v);
    line += fmt::format(",{:.0f},{}", visible, c_.world->responding());
    for (const double v : {believed.x, believed.y, to.x, to.y, b.x * 1e6, b.y * 1e6}) line += cell(v);
    for (const double i : t.command.current) line += cell(i);
    file_.append(line + fmt::format(",{:d}\n", t.limited));
  }

  void checkpoint(Archive& a) override {
    file_.sync();
    std::uint64_t length = file_.size();
    a& length;
  }
  void finish(bool) override {
    file_.sync();
    file_.close();
  }

 private:
  /// Empty for what is no number, such as the distance to no setpoint.
  static std::string cell(double v) { return std::isfinite(v) ? fmt::format(",{:.9g}", v) : ","; }
  std::string header() const {
    std::string h =
        "frame,t_s,centroid_x_px,centroid_y_px,sigma_x_px,sigma_y_px,rms_radius_px,distance_px,visible_count,"
        "responding_count,estimate_x_px,estimate_y_px,setpoint_x_px,setpoint_y_px,field_x_ut,field_y_ut";
    for (std::size_t k = 0; k < c_.world->parts().field->coils(); ++k) h += fmt::format(",current_{}_a", k);
    return h + ",limited\n";
  }
  SinkContext c_;
  OutputFile file_;
};

}  // namespace

std::unique_ptr<RunSink> series_sink(const SinkContext& c, Archive* resume) {
  std::uint64_t keep = 0;
  if (resume) *resume& keep;
  return std::make_unique<Series>(c, keep);
}

}  // namespace faba
