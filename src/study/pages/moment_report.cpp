#include "study/pages/moment_report.h"

#include <nlohmann/json.hpp>

#include "study/pages/quality_output.h"

namespace faba {
namespace {

using OrderedJson = nlohmann::ordered_json;

OrderedJson median_json(const std::optional<MedianInterval>& m) {
  return m ? OrderedJson{{"median", m->median}, {"ci90", m->ci90}} : OrderedJson();
}

}  // namespace

nlohmann::ordered_json moment_json(const MomentEstimate& e) {
  OrderedJson j;
  j["moment_am2"] = median_json(e.moment);
  j["rate_per_t_per_s"] = median_json(e.rate_per_t);
  j["drag_nms"] = e.drag ? OrderedJson(*e.drag) : OrderedJson();
  j["turns"] = e.turns;
  j["videos"] = OrderedJson::array();
  for (const FieldStrength& f : e.fields) {
    const UTurnSurvey& s = f.survey;
    OrderedJson v;
    v["file"] = f.file.string();
    v["field_t"] = f.field_t;
    v["turns"] = s.turns.size();
    v["cells"] = s.cells;
    v["rate_per_t_per_s"] = median_json(f.rate_per_t);
    v["bias"] = f.bias;
    v["half_time_s"] = s.turns.empty() ? OrderedJson() : OrderedJson(s.half_s);
    v["window_s"] = s.turns.empty() ? OrderedJson() : OrderedJson(s.window_s);
    v["kappa"] = s.turns.empty() || !(s.disorder > 0) ? OrderedJson() : OrderedJson(1 / s.disorder);
    v["turn_speed"] = s.turn_speed ? OrderedJson(*s.turn_speed) : OrderedJson();
    j["videos"].push_back(std::move(v));
  }
  add_quality(j, e.warnings);
  return j;
}

}  // namespace faba
