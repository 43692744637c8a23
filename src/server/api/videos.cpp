#include <fmt/format.h>

#include <cmath>
#include <cstring>

#include "core/error.h"
#include "core/file.h"
#include "server/api/lab_services.h"
#include "server/api/responses.h"
#include "server/files/file_time.h"
#include "server/request_values.h"
#include "server/videos/open_videos.h"
#include "study/data/frame_flow.h"
#include "study/data/run_video.h"
#include "study/drop/proposed_drop.h"
#include "study/pages/drop_report.h"

namespace faba {
namespace {

namespace fs = std::filesystem;

constexpr int kThumbnailWidth = 320, kMostWidth = 16384;  // px
constexpr std::uint64_t kMostFrames = 64;                 // in one response
constexpr std::size_t kMostBatch = std::size_t{24} << 20;

int width_of(const WebRequest& r) {
  const double width = query_number(r, "width", 0);
  if (width < 0 || width > kMostWidth)
    throw Error(Errc::usage, "width",
                fmt::format("{} px is out of range; it must be between 0 and {} px", width, kMostWidth));
  return int(width);
}

// Calls `use` with the video that the page names; errors name it as the page does.
void with_video(OpenVideos& videos, const LabServices& lab, const WebRequest& r,
                const std::function<void(VideoFrames&)>& use) {
  const std::string name = query_text(r, "file");
  if (name.empty())
    throw Error(Errc::usage, "file", "is missing; it must be the name of a video of the workspace");
  const fs::path path = lab.workspace.existing(name);
  const auto find = [&] {
    RunVideo video = run_video(path);
    video.file = lab.workspace.existing(video.file.string());
    return video;
  };
  try {
    videos.with(path, use, find);
  } catch (const Error& e) {
    if (!e.where().starts_with(path.string())) throw;
    throw Error(e.code(), name + e.where().substr(path.string().size()), e.reason());
  }
}

double time_of(const WebRequest& r, const VideoFrames& video) {
  if (query_text(r, "index").empty()) return query_number(r, "t", 0);
  return query_number(r, "index", 0) / (video.fps() > 0 ? video.fps() : 1);
}

// The full grey scale of 8 bits; of more bits, cameras often use a small part.
FrameLook default_look(const VideoFrames& video, const VideoFrame& frame) {
  if (video.bits() <= 8) return {};
  const GreyHistogram h = grey_histogram(frame.grey);
  return {.low = h.low, .high = h.high};
}

FrameLook look_of(const WebRequest& r, const VideoFrames& video, const VideoFrame& frame) {
  FrameLook look;
  if (query_text(r, "low").empty() || query_text(r, "high").empty()) look = default_look(video, frame);
  look.low = query_number(r, "low", look.low);
  look.high = query_number(r, "high", look.high);
  look.width = width_of(r);
  return look;
}

Json histogram_json(const GreyHistogram& h) {
  return {{"least", h.least}, {"most", h.most}, {"step", h.step},
          {"low", h.low},     {"high", h.high}, {"counts", h.counts}};
}

Json about(VideoFrames& video) {
  const double rate = video.fps() > 0 ? video.fps() : 1;
  const FrameLook look = default_look(video, *video.at(0));
  const VideoScale& scale = video.scale();
  return {{"width", video.width()},
          {"height", video.height()},
          {"bits", video.bits()},
          {"fps", video.fps()},
          {"frames", video.frames_stated()},
          {"length_s", double(video.frames_stated()) / rate},
          {"low", look.low},
          {"high", look.high},
          {"um_per_px", scale.um_per_px ? Json(*scale.um_per_px) : Json()},
          {"um_per_px_source", scale.source},
          {"note", scale.ignored},
          {"damage", video.damage()}};
}

// Looks for the last frame, which may take a while without an index in the file.
Json end_of(VideoFrames& video) {
  const VideoFrameRef last = video.last();
  const double rate = video.fps() > 0 ? video.fps() : 1;
  return {{"frames", last->index + 1}, {"length_s", last->t_s + 1 / rate}, {"damage", video.damage()}};
}

// The flow from a frame to the next one; no arrows at the end.
Json flow_json(const WebRequest& r, VideoFrames& video) {
  const VideoFrameRef first = video.at(time_of(r, video)), second = video.next();
  Json arrows = Json::array();
  if (second)
    for (const FlowArrow& a : flow_arrows(first->grey, second->grey, video.bits()))
      arrows.push_back({a.x, a.y, a.u, a.v});
  return {{"t_s", first->t_s}, {"arrows", arrows}};
}

template <class T>
void append(std::string& out, const T& value) {
  out.append(reinterpret_cast<const char*>(&value), sizeof value);
}

// See web/protocol.md.
void append_frame(std::string& out, const VideoFrame& frame, const FrameLook& look) {
  const Gray8 shown = displayed_frame(frame.grey, look);
  append(out, std::uint32_t(16 + shown.px.size()));
  append(out, frame.t_s);
  append(out, std::uint32_t(frame.index));
  append(out, std::uint16_t(shown.width));
  append(out, std::uint16_t(shown.height));
  out.append(reinterpret_cast<const char*>(shown.px.data()), shown.px.size());
}

std::string batch(const WebRequest& r, VideoFrames& video) {
  const double count = query_number(r, "count", 1);
  VideoFrameRef frame = video.at(query_number(r, "from", 0));
  const FrameLook look = look_of(r, video, *frame);
  std::string out;
  for (std::uint64_t k = 0; frame && double(k) < count && k < kMostFrames && out.size() < kMostBatch; ++k) {
    append_frame(out, *frame, look);
    if (double(k + 1) < count && k + 1 < kMostFrames) frame = video.next();
  }
  return out;
}

WebResponse thumbnail(const LabServices& lab, const WebRequest& r) {
  OpenVideos alone;  // must not close the videos that pages display
  const fs::path path = lab.workspace.existing(query_text(r, "file"));
  const auto changed = fs::last_write_time(path).time_since_epoch().count();
  const fs::path file =
      lab.pictures / fmt::format("video-{:x}-{}.png", std::hash<std::string>{}(path.string()), changed);
  if (!fs::exists(file))
    with_video(alone, lab, r, [&](VideoFrames& video) {
      const VideoFrameRef first = video.at(0);
      const GreyHistogram h = grey_histogram(first->grey);
      write_file(file, displayed_png(first->grey, {kThumbnailWidth, h.low, h.high}));
    });
  return file_answer(file);
}

}  // namespace

void add_video_routes(Routes& routes, const LabServices& lab) {
  const auto videos = std::make_shared<OpenVideos>();
  const auto with = [&lab, videos](const WebRequest& r, const std::function<void(VideoFrames&)>& use) {
    with_video(*videos, lab, r, use);
  };
  routes.add("GET", "/api/videos/about", [&lab, with](const auto& r, const auto&) {
    Json j;
    with(r, [&](VideoFrames& v) { j = about(v); });
    j["modified_s"] = modified_s(lab.workspace.existing(query_text(r, "file")));
    return json_answer(j);
  });
  routes.add("GET", "/api/videos/end", [with](const auto& r, const auto&) {
    Json j;
    with(r, [&](VideoFrames& v) { j = end_of(v); });
    return json_answer(j);
  });
  routes.add("GET", "/api/videos/histogram", [with](const auto& r, const auto&) {
    Json j;
    with(r, [&](VideoFrames& v) { j = histogram_json(grey_histogram(v.at(time_of(r, v))->grey)); });
    return json_answer(j);
  });
  routes.add("GET", "/api/videos/flow", [with](const auto& r, const auto&) {
    Json j;
    with(r, [&](VideoFrames& v) { j = flow_json(r, v); });
    return json_answer(j);
  });
  routes.add("GET", "/api/videos/edge", [with](const auto& r, const auto&) {
    Json j;
    with(r, [&](VideoFrames& v) {
      j = drop_json(propose_drop(v.at(time_of(r, v))->grey, query_text(r, "file")));
    });
    return json_answer(j);
  });
  routes.add("GET", "/api/videos/frame", [with](const auto& r, const auto&) {
    WebResponse png{.type = "image/png", .body = {}};
    with(r, [&](VideoFrames& v) {
      const VideoFrameRef frame = v.at(time_of(r, v));
      png.body = displayed_png(frame->grey, look_of(r, v, *frame));
    });
    return png;
  });
  routes.add("GET", "/api/videos/frames", [with](const auto& r, const auto&) {
    WebResponse frames{.type = "application/octet-stream", .body = {}};
    with(r, [&](VideoFrames& v) { frames.body = batch(r, v); });
    return frames;
  });
  routes.add("GET", "/api/videos/thumbnail.png",
             [&lab](const auto& r, const auto&) { return thumbnail(lab, r); });
}

}  // namespace faba
