#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cctype>
#include <functional>

#include "core/error.h"
#include "server/api/lab_services.h"
#include "server/api/responses.h"
#include "server/api/rulers.h"
#include "server/experiments/experiment_store.h"
#include "server/files/opened_input.h"
#include "server/request_values.h"
#include "study/data/run_video.h"
#include "study/pages/drop_report.h"

namespace faba {
namespace {

namespace fs = std::filesystem;

std::string next_name(const char* kind) {
  static std::atomic<unsigned> number{0};
  return fmt::format("{}-{}", kind, ++number);
}

// Errors give the user's name of a file instead of its path.
template <class F>
auto under_name(const std::string& name, const fs::path& file, const F& read) {
  try {
    return read();
  } catch (const Error& e) {
    std::string reason = e.reason();
    for (std::size_t at = 0; (at = reason.find(file.string(), at)) != std::string::npos; at += name.size())
      reason.replace(at, file.string().size(), name);
    throw Error(e.code() == Errc::input ? Errc::usage : e.code(), name, reason);
  }
}

// The scale of an experiment from a picture of a ruler, which is kept in the folder of the experiment.
Json take_ruler(const LabServices& lab, const WebRequest& r) {
  const std::string experiment = query_text(r, "experiment");
  (void)lab.experiments.folder(experiment);
  const std::string name = safe_name(fs::path(query_text(r, "name")).filename().string());
  const std::string extension = fs::path(name).extension().string();
  // The type of a picture is known by its name.
  const fs::path named = r.upload.string() + extension;
  fs::rename(r.upload, named);
  try {
    Json j = measure_ruler(lab, named, query_number(r, "tick_um", 0), "experiments/" + experiment + "/ruler",
                           extension);
    fs::remove(named);
    return j;
  } catch (const Error& e) {
    fs::remove(named);
    throw Error(Errc::usage, e.where().empty() ? name : e.where(), e.reason());
  }
}

// The edge of the drop in a picture, and the address of the picture as PNG.
Json detected_drop(const LabServices& lab, const fs::path& file, const std::string& name) {
  const std::string shown = next_name("shown") + ".png";
  Json j = drop_json(report_proposed_drop(file, name, lab.pictures / shown));
  j["picture"] = fs::path(name).filename();
  j["url"] = "/api/uploads/" + shown;
  return j;
}

std::string extension_of(const std::string& name) {
  constexpr std::size_t kLongest = 6;
  const std::string ending = fs::path(name).extension().string();
  const bool plain = ending.size() <= kLongest &&
                     std::all_of(ending.begin(), ending.end(),
                                 [](unsigned char c) { return c == '.' || std::isalnum(c) != 0; });
  return plain ? ending : "";
}

// The original is kept until the lab ends, so that a scenario can use it.
Json take_upload(const LabServices& lab, const WebRequest& r) {
  std::string name = fs::path(query_text(r, "name")).filename().string();
  if (name.empty()) name = "picture";
  const std::string kept = next_name("original") + extension_of(name);
  return under_name(name, r.upload, [&] {
    Json j = detected_drop(lab, r.upload, name);
    fs::copy_file(r.upload, lab.pictures / kept);
    j["upload"] = kept;
    return j;
  });
}

Json detect(const LabServices& lab, const Json& asked) {
  const std::string name = text_of(asked, "file");
  const fs::path file = run_video(lab.workspace.existing(name)).file;
  return under_name(name, file, [&] {
    // The folder, because metadata may be in a file beside the picture.
    return with_opened(file.parent_path(), name, [&](const fs::path& folder) {
      Json j = detected_drop(lab, folder / file.filename(), name);
      j["file"] = name;
      return j;
    });
  });
}

Json keep(const LabServices& lab, const Json& asked) {
  const std::string upload = text_of(asked, "upload");
  const fs::path file = lab.pictures / fs::path(upload).filename();
  if (!upload.starts_with("original-") || !fs::is_regular_file(file))
    throw Error(Errc::input, upload, "the picture is not in the lab any more; choose it again");
  const std::string asked_name = text_of(asked, "name"),
                    name = safe_name(fs::path(asked_name).filename().string());
  if (name.empty())
    throw Error(Errc::usage, "name",
                fmt::format("\"{}\" must have at least one letter or digit", asked_name));
  return {{"file", lab.workspace.keep_picture(file, name)}};
}

// Rendered again only if the file has changed.
WebResponse shown_picture(const LabServices& lab, const WebRequest& r) {
  const std::string name = query_text(r, "file");
  if (name.empty()) throw Error(Errc::usage, "file", "missing; it must be a non-empty string");
  const fs::path file = lab.workspace.scenario_file(name);
  std::error_code ec;
  const auto changed = fs::last_write_time(file, ec).time_since_epoch().count();
  if (ec) throw Error(Errc::input, name, "file not found");
  const fs::path png =
      lab.pictures / fmt::format("file-{:x}-{}.png", std::hash<std::string>()(file.string()), changed);
  if (!fs::exists(png))
    under_name(name, file, [&] {
      with_opened(file.parent_path(), name,
                  [&](const fs::path& folder) { write_displayed_picture(folder / file.filename(), png); });
    });
  return picture_answer(png);
}

// The pictures that the lab has rendered; not the uploaded files, nor the file that opens the browser.
WebResponse shown_upload(const LabServices& lab, const std::string& name) {
  const fs::path file = lab.pictures / name;
  const bool rendered = name.starts_with("shown-") || name.starts_with("ruler-");
  if (!rendered || file.extension() != ".png" || !fs::is_regular_file(file))
    throw Error(Errc::input, name, "file not found");
  return file_answer(file);
}

}  // namespace

void add_upload_routes(Routes& routes, const LabServices& lab) {
  routes.add("POST", "/api/upload",
             [&lab](const auto& r, const auto&) { return json_answer(take_upload(lab, r)); });
  routes.add("POST", "/api/upload/ruler",
             [&lab](const auto& r, const auto&) { return json_answer(take_ruler(lab, r)); });
  routes.add("GET", "/api/uploads/*",
             [&lab](const auto&, const auto& names) { return shown_upload(lab, names[0]); });
  routes.add("GET", "/api/pictures",
             [&lab](const auto&, const auto&) { return json_answer(lab.workspace.pictures()); });
  routes.add("POST", "/api/pictures/detect",
             [&lab](const auto& r, const auto&) { return json_answer(detect(lab, body_of(r))); });
  routes.add("POST", "/api/pictures/keep",
             [&lab](const auto& r, const auto&) { return json_answer(keep(lab, body_of(r))); });
  routes.add("GET", "/api/pictures/shown.png",
             [&lab](const auto& r, const auto&) { return shown_picture(lab, r); });
}

}  // namespace faba
