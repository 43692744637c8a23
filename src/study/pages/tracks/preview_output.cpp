#include "study/pages/tracks/preview_output.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "core/counted.h"
#include "core/error.h"
#include "study/pages/quality_output.h"
#include "study/pages/tracks/track_json.h"
#include "vision/draw/contact_sheet.h"
#include "vision/files/picture.h"

namespace faba {
namespace {

constexpr double kSpotRing = 5;  // px between a spot and the ring around it

const char* source_of(bool given) { return given ? "given" : "estimated"; }

RgbImage sheet_of(const TrackPreview& p) {
  const TrackDetection& d = p.detection;
  SheetStyle style;
  style.title = fmt::format("size {:.3g} px ({}), threshold {:.3g} ({}), {}, background: {}", d.size_px,
                            source_of(d.size_given), d.threshold_snr, source_of(d.threshold_given),
                            word_of(d.polarity), background_word(d));
  style.black = p.survey.black;
  style.white = p.survey.white;
  style.ring_px = 0.5 * d.size_px + kSpotRing;
  style.region = p.survey.region;
  std::vector<SheetFrame> frames;
  for (const PreviewFrame& f : p.frames) {
    SheetFrame sheet{f.picture, {}, fmt::format("{:.4g} s: {}", f.t_s, counted(f.spots.size(), "detection"))};
    for (const Spot& s : f.spots) sheet.marks.push_back({s.x_px, s.y_px});
    frames.push_back(std::move(sheet));
  }
  return contact_sheet(frames, style);
}

}  // namespace

TrackPreview preview_video(const TrackOptions& o, const std::filesystem::path& picture,
                           const TrackProgress& progress) {
  TrackPreview preview = preview_tracks(o, run_video(o.video), [&](std::int64_t done, std::int64_t total) {
    if (progress && !progress(done, total))
      throw Error(Errc::interrupted, o.video.string(), "stopped before the end; no file was written");
  });
  write_png(picture, sheet_of(preview));
  return preview;
}

nlohmann::ordered_json preview_json(const TrackPreview& p) {
  nlohmann::ordered_json j{{"detection", detection_json(p.detection)}};
  j["frames"] = nlohmann::ordered_json::array();
  for (const PreviewFrame& f : p.frames) j["frames"].push_back({{"t_s", f.t_s}, {"spots", f.spots.size()}});
  add_quality(j, p.warnings);
  j["notes"] = p.notes;
  return j;
}

}  // namespace faba
