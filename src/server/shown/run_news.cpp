#include "server/shown/run_news.h"

#include <cmath>

namespace faba {
namespace {

Json box_json(const PictureBox& b) { return {b.left, b.top, b.right, b.bottom}; }

// Name and largest current of every coil; a coil without a name has an empty one.
Json coils_json(const Field& field, double limit) {
  Json coils = Json::array();
  const std::vector<double> most = field.max_currents(limit);
  for (std::size_t k = 0; k < field.coils(); ++k)
    coils.push_back({{"name", field.circuit(k).name}, {"max_a", most[k]}});
  return coils;
}

}  // namespace

Json parts_news(const ShownRun& shown) {
  const Simulation& s = shown.live.simulation();
  Json setpoints = Json::array();
  for (const Vec2 p : s.reference().setpoints()) {
    const Vec2 at = s.frame().image_from_world(p);
    if (std::isfinite(at.x)) setpoints.push_back({at.x, at.y});
  }
  return {{"say", "parts"},
          {"scenario", shown.live.scenario().resolved()},
          {"setpoints", setpoints},
          {"events", shown.live.exchanges()}};
}

Json run_news(const ShownRun& shown, std::uint32_t number) {
  const LiveRun& live = shown.live;
  const Simulation& s = shown.live.simulation();
  const ScaleParams& scale = live.scenario().scale;
  const World& w = s.world();
  const Outline edge = w.parts().arena->outline();
  Json populations = Json::array();
  for (const Population& p : w.parts().populations)
    populations.push_back(
        {{"begin", p.begin}, {"end", p.end}, {"polarity", p.polarity > 0 ? "north" : "south"}});
  Json j = parts_news(shown);
  j["say"] = "run";
  j["run"] = number;
  j["seed"] = live.seed();
  j["frame"] = {{"width", s.frame().width},
                {"height", s.frame().height},
                {"um_per_px", scale.um_per_px ? Json(*scale.um_per_px) : Json()},
                {"nominal_um_per_px", scale.used_um_per_px()},
                {"rate", live.scenario().camera.rate}};
  j["outline"] = {{"centre_px", {edge.centre_image.x, edge.centre_image.y}}, {"radius_px", edge.radius_px}};
  j["box"] = box_json(shown.box);
  j["populations"] = populations;
  j["coils"] = coils_json(*w.parts().field, live.scenario().limits.max_current);
  j["columns"] = shown.columns;
  return j;
}

Json history_news(const ShownRun& shown, std::uint32_t number) {
  Json rows = Json::array();
  for (std::size_t k = 0; k < shown.history.size(); ++k) {
    Json row = Json::array();
    for (const double v : shown.history.row(k)) row.push_back(v);  // written as null if not finite
    rows.push_back(std::move(row));
  }
  return {{"say", "history"}, {"run", number}, {"rows", std::move(rows)}};
}

}  // namespace faba
