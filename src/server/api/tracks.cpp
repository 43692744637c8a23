#include <cstdlib>

#include "core/error.h"
#include "server/api/lab_services.h"
#include "server/api/responses.h"
#include "server/request_values.h"
#include "server/tracks/probe_list.h"
#include "server/tracks/track_request.h"
#include "server/tracks/track_results.h"
#include "study/pages/tracks/probe_json.h"

namespace faba {
namespace {

namespace fs = std::filesystem;

// What the requests for tracks share.
struct TrackServices {
  explicit TrackServices(const LabServices& l) : lab(l), results(l.workspace) {}
  const LabServices& lab;
  ProbeList probes;
  TrackResults results;
};

std::int64_t integer_of(const Json& asked, const char* key, std::int64_t least, std::int64_t most) {
  const auto it = asked.find(key);
  if (it == asked.end() || !it->is_number_integer() || *it < least || *it > most)
    throw Error(Errc::usage, key,
                "must be an integer between " + std::to_string(least) + " and " + std::to_string(most));
  return it->get<std::int64_t>();
}

constexpr std::int64_t kLastFrame = 1'000'000'000, kMostLinked = 50;

// Answers {"ready": false, "done", "of"} until the video is surveyed.
Json probe(TrackServices& t, const Json& asked, bool link) {
  const TrackRequest request = track_request(t.lab.workspace, asked);
  const std::int64_t frame = integer_of(asked, "frame", 0, kLastFrame);
  const ProbeList::State s = t.probes.get(request.options);
  if (!s.probe) return {{"ready", false}, {"done", s.done}, {"of", s.of}};
  Json j = link ? links_json(
                      s.probe->link(request.options, frame, int(integer_of(asked, "frames", 2, kMostLinked))))
                : probe_json(s.probe->detect(request.options, frame));
  const IndexedFrames& video = s.probe->frames();
  const auto& um = s.probe->scale().um_per_px;
  j["ready"] = true;
  j["video"] = {{"width", video.width()},
                {"height", video.height()},
                {"frames", video.stated()},
                {"fps", video.fps()},
                {"black", s.probe->black()},
                {"white", s.probe->white()},
                {"um_per_px", um ? Json(*um) : Json(nullptr)}};
  return j;
}

Json start(TrackServices& t, const Json& asked) {
  const TrackRequest request = track_request(t.lab.workspace, asked);
  const std::string folder = t.results.new_folder(request.file);
  // A leading dash would be an option.
  const std::string video = request.file.starts_with('/') ? request.file : "./" + request.file;
  std::vector<std::string> words = {"track", video, "--result", folder, "--json"};
  words.insert(words.begin() + 2, request.words.begin(), request.words.end());
  const int id = t.lab.jobs.add({.title = "track: " + fs::path(request.file).filename().string(),
                                 .words = std::move(words),
                                 .page = folder + "/" + track_files::kReport,
                                 .out = folder});
  return {{"id", id}, {"folder", folder}};
}

// A file of a result: the names are fixed.
WebResponse result_file(TrackServices& t, const WebRequest& r, const std::string& name) {
  for (const char* known : {"tracks.csv", "per_track.csv", "tracks.html", "track.json", "edits.toml",
                            "edited_tracks.csv", "edited_features.csv"})
    if (name == known) return output_answer(t.lab.workspace.existing(query_text(r, "folder") + "/" + name));
  throw Error(Errc::input, name.substr(0, 80), "is not a file of a tracked video");
}

}  // namespace

void add_track_routes(Routes& routes, const LabServices& lab) {
  const auto t = std::make_shared<TrackServices>(lab);
  routes.add("GET", "/api/tracks", [t](const auto&, const auto&) { return json_answer(t->results.list()); });
  routes.add("POST", "/api/tracks",
             [t](const auto& r, const auto&) { return json_answer(start(*t, body_of(r))); });
  routes.add("POST", "/api/tracks/detect",
             [t](const auto& r, const auto&) { return json_answer(probe(*t, body_of(r), false)); });
  routes.add("POST", "/api/tracks/link",
             [t](const auto& r, const auto&) { return json_answer(probe(*t, body_of(r), true)); });
  routes.add("GET", "/api/tracks/result", [t](const auto& r, const auto&) {
    return json_answer(t->results.read(query_text(r, "folder")));
  });
  routes.add("GET", "/api/tracks/points", [t](const auto& r, const auto&) {
    return WebResponse{.type = "application/octet-stream",
                       .body = t->results.points(query_text(r, "folder"))};
  });
  routes.add("GET", "/api/tracks/edited", [t](const auto& r, const auto&) {
    return json_answer(t->results.edited(query_text(r, "folder")));
  });
  routes.add("POST", "/api/tracks/edits", [t](const auto& r, const auto&) {
    const Json asked = body_of(r);
    return json_answer(t->results.change(text_of(asked, "folder"), asked));
  });
  routes.add("POST", "/api/tracks/export", [t](const auto& r, const auto&) {
    return json_answer(t->results.write(text_of(body_of(r), "folder")));
  });
  routes.add("GET", "/api/tracks/file/*",
             [t](const auto& r, const auto& names) { return result_file(*t, r, names[0]); });
}

}  // namespace faba
