#include "server/shown/shown_run.h"

#include <cmath>
#include <cstddef>
#include <limits>

namespace faba {
namespace {

constexpr std::size_t kRows = 32;  // rows of the series per message; pages that missed messages need several
constexpr std::size_t kHistory = 1200;  // rows for pages that connect later; a plot has about as many pixels
constexpr int kFieldColumns = 17, kFieldRows = 13;
constexpr std::size_t kMostHeadings = 20000;  // headings are not visible for more cells

}  // namespace

ShownRun::ShownRun(const Document& d, std::uint64_t seed, const Parts& parts, Pool& pool)
    : document(d),
      live(d, seed, parts, pool),
      row(series_context(live.scenario(), live.simulation(), pool)),
      columns(row.names()),
      history(kHistory) {
  columns.emplace_back("activity_um_s");
  const Simulation& s = live.simulation();
  const Grid g = s.world().parts().arena->grid();
  const Vec2 low{double(g.left), double(g.low)};
  const Vec2 corner = s.frame().image_from_world(low);
  const Vec2 opposite =
      s.frame().image_from_world(low + double(g.cell) * Vec2{double(g.columns), double(g.rows)});
  box = {corner.x, opposite.y, opposite.x, corner.y};
  for (const Population& p : s.world().parts().populations) ends.push_back(p.end);
  const bool varies = s.world().parts().table.has_value();
  const int nx = varies ? kFieldColumns : 1, ny = varies ? kFieldRows : 1;
  for (int j = 0; j < ny; ++j)
    for (int i = 0; i < nx; ++i) {
      const Vec2 at =
          s.frame().world_from_image({(s.frame().width - 1) * (varies ? double(i) / (nx - 1) : 0.5),
                                      (s.frame().height - 1) * (varies ? double(j) / (ny - 1) : 0.5)});
      field_x.push_back(float(at.x));
      field_y.push_back(float(at.y));
    }
  field_columns = nx;
  field_rows = ny;
  live.simulation().loop().sinks.push_back(this);
}

void ShownRun::take(const Tick& t) {
  estimate = t.estimate;
  std::vector<double> v = row.values(t);
  const double now = live.simulation().rig().time_of(t.index);
  v.push_back(mean_speed(now - time) * 1e6);
  time = now;
  history.add(v);
  if (rows.size() == kRows * v.size()) rows.erase(rows.begin(), rows.begin() + std::ptrdiff_t(v.size()));
  rows.insert(rows.end(), v.begin(), v.end());
}

double ShownRun::mean_speed(double dt) {
  const auto& agents = live.simulation().world().state().agents;
  const std::span<const float> x = agents["x"], y = agents["y"];
  double distance = 0;
  const bool first = before_x.empty();
  if (first) {
    before_x.resize(x.size());
    before_y.resize(x.size());
  }
  for (std::size_t i = 0; i < x.size(); ++i) {
    distance += std::hypot(double(x[i]) - double(before_x[i]), double(y[i]) - double(before_y[i]));
    before_x[i] = x[i];
    before_y[i] = y[i];
  }
  return first || !(dt > 0) ? std::numeric_limits<double>::quiet_NaN() : distance / (double(x.size()) * dt);
}

std::shared_ptr<const std::string> ShownRun::message(std::uint32_t run, bool camera, int sites) {
  Simulation& s = live.simulation();
  const World& w = s.world();
  const auto& agents = w.state().agents;
  FrameMessage m;
  m.run = run;
  m.frame = live.frame() - 1;
  m.t = time;
  m.view = s.frame();
  m.box = box;
  m.x = agents["x"];
  m.y = agents["y"];
  m.response = agents["response"];
  if (agents.has("ux") && m.x.size() <= kMostHeadings) {
    m.ux = agents["ux"];
    m.uy = agents["uy"];
  }
  m.ends = ends;
  m.sites = sites;
  m.estimate = &estimate;
  const auto plan = s.controller().plan();
  if (plan) {
    m.path = plan->path;
    m.path_step = plan->step;
    for (const auto limit : plan->active) m.limits = std::uint16_t(m.limits | (1U << unsigned(limit)));
  }
  m.rows = rows;
  m.columns = columns.size();
  const std::size_t n = field_x.size();
  std::vector<float> bx(n), by(n), field(2 * n);
  if (w.parts().table)
    w.parts().table->eval({field_x, field_y}, {bx, by});
  else
    w.parts().field->eval({field_x, field_y}, w.state().current, {bx, by});
  for (std::size_t i = 0; i < n; ++i) {
    field[2 * i] = bx[i];
    field[2 * i + 1] = -by[i];
  }
  m.field_columns = field_columns;
  m.field_rows = field_rows;
  m.field = field;
  ImageRef picture;
  if (camera) {
    picture = s.rig().picture();
    m.picture = picture->px;
    m.picture_columns = picture->width;
    m.picture_rows = picture->height;
  }
  return std::make_shared<const std::string>(encode_frame(m));
}

}  // namespace faba
