#include "study/pages/tracks/probe_json.h"

#include <nlohmann/json.hpp>

#include "core/toml.h"
#include "study/pages/quality_output.h"
#include "study/pages/tracks/track_json.h"

namespace faba {

nlohmann::ordered_json probe_json(const ProbedFrame& f) {
  Json spots = Json::array();
  for (const Spot& s : f.spots) spots.push_back({s.x_px, s.y_px, s.size_px, s.snr});
  Json j{{"frame", f.index},
         {"t_s", f.t_s},
         {"spots", std::move(spots)},
         {"detection", detection_json(f.detection)}};
  add_quality(j, f.warnings);
  return j;
}

nlohmann::ordered_json links_json(const ProbedLinks& links) {
  Json tracks = Json::array();
  for (const Track& t : links.tracks) {
    Json points = Json::array();
    for (const TrackPoint& p : t.points) points.push_back({p.frame, p.x_px, p.y_px});
    tracks.push_back(std::move(points));
  }
  return {{"first", links.first},
          {"frames", links.frames},
          {"tracks", std::move(tracks)},
          {"reach_px", links.search_radius_px},
          {"motion", word_of(links.motion)},
          {"crowded", links.crowded}};
}

}  // namespace faba
