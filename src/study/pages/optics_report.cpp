#include "study/pages/optics_report.h"

#include <nlohmann/json.hpp>

#include "study/optics/optics_verdicts.h"
#include "study/pages/quality_output.h"

namespace faba {
namespace {

constexpr double kUm = 1e6;  // um per m

Json verdict_json(const OpticsVerdict& v) {
  Json j{
      {"measurement", word_of(v.measurement)}, {"title", title_of(v.measurement)}, {"evidence", v.evidence}};
  add_quality(j, v.warnings);
  return j;
}

}  // namespace

nlohmann::ordered_json optics_json(const OpticsSetup& setup) {
  const OpticsPlan p = optics_plan(setup);
  Json j{{"setup", OpticsSetup::schema().to_json(setup)},
         {"um_per_px", p.um_per_px},
         {"view_um", {kUm * p.view_width, kUm * p.view_height}},
         {"cell_px", p.cell_px},
         {"cell_length_px", p.cell_length_px},
         {"object_px", p.object_px},
         {"cells_in_view", p.cells_in_view},
         {"spacing_px", p.spacing_px},
         {"crossing_time_s", p.crossing_time},
         {"crossing_frames", p.crossing_frames},
         {"displacement_px", p.displacement_px},
         {"displacement_um", p.displacement_px * p.um_per_px},
         {"exposure_time_s", p.exposure_time},
         {"blur_px", p.blur_px},
         {"resolution_um", kUm * p.resolution},
         {"psf_sd_um", kUm * p.psf_sd},
         {"depth_of_field_um", kUm * p.depth_of_field},
         {"gathering_time_s", p.gathering_time},
         {"arc_deg", p.arc_deg},
         {"radius_error", p.radius_error},
         {"drop_radius_um", kUm * setup.drop_radius}};
  Json verdicts = Json::array();
  for (const OpticsVerdict& v : optics_verdicts(setup, p)) verdicts.push_back(verdict_json(v));
  j["verdicts"] = std::move(verdicts);
  return j;
}

}  // namespace faba
