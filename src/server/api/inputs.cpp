#include <fmt/format.h>

#include <mutex>

#include "core/error.h"
#include "core/hash.h"
#include "server/api/lab_services.h"
#include "server/api/responses.h"
#include "server/jobs/input_files.h"
#include "study/pages/thumbnail.h"

namespace faba {
namespace {

namespace fs = std::filesystem;
constexpr int kThumbnailSide = 200;  // px

std::string file_of(const WebRequest& r) {
  const auto file = r.query.find("file");
  if (file == r.query.end()) throw Error(Errc::usage, "file", "missing; it must be a file of the workspace");
  return file->second;
}

// Read again only if the file has changed.
fs::path picture_of(const LabServices& lab, const std::string& name) {
  const fs::path file = lab.workspace.existing(name);
  Hash h;
  h.text(fmt::format("{} {}", file.string(), fs::last_write_time(file).time_since_epoch().count()));
  fs::path png = lab.pictures / fmt::format("input-{}.png", h.hex());
  static std::mutex one_at_a_time;
  const std::lock_guard lock(one_at_a_time);
  if (!fs::exists(png)) write_frame_thumbnail(file, png, kThumbnailSide);
  return png;
}

}  // namespace

void add_input_routes(Routes& routes, const LabServices& lab) {
  routes.add("GET", "/api/inputs",
             [&lab](const auto&, const auto&) { return json_answer(input_files(lab.workspace)); });
  routes.add("GET", "/api/inputs/facts", [&lab](const auto& r, const auto&) {
    return json_answer(facts_of_input(lab.workspace, file_of(r)));
  });
  routes.add("GET", "/api/inputs/picture.png",
             [&lab](const auto& r, const auto&) { return picture_answer(picture_of(lab, file_of(r))); });
}

}  // namespace faba
