#include <fmt/format.h>

#include <atomic>
#include <cstdlib>

#include "core/error.h"
#include "server/api/lab_services.h"
#include "server/api/responses.h"
#include "server/api/rulers.h"
#include "study/pages/drop_report.h"

namespace faba {
namespace {

namespace fs = std::filesystem;

Json take_upload(const LabServices& lab, const WebRequest& r) {
  static std::atomic<unsigned> number{0};
  const auto named = r.query.find("name");
  const std::string name = named == r.query.end() ? "picture" : fs::path(named->second).filename().string();
  const std::string shown = fmt::format("upload-{}.png", ++number);
  try {
    Json j = drop_json(report_proposed_drop(r.upload, name, lab.pictures / shown));
    j["picture"] = name;
    j["url"] = "/api/uploads/" + shown;
    return j;
  } catch (const Error& e) {
    if (e.code() != Errc::input) throw;
    throw Error(Errc::usage, name, e.reason());  // replaces the name of the temporary file
  }
}

// The scale of an experiment from a picture of a ruler, which is kept in the folder of the experiment.
Json take_ruler(const LabServices& lab, const WebRequest& r) {
  const auto value = [&](const char* key) {
    const auto it = r.query.find(key);
    return it == r.query.end() ? std::string() : it->second;
  };
  const std::string experiment = value("experiment");
  (void)lab.experiments.folder(experiment);
  const std::string name = safe_name(fs::path(value("name")).filename().string());
  const std::string extension = fs::path(name).extension().string();
  // The type of a picture is known by its name.
  const fs::path named = r.upload.string() + extension;
  fs::rename(r.upload, named);
  try {
    Json j = measure_ruler(lab, named, std::strtod(value("tick_um").c_str(), nullptr),
                           "experiments/" + experiment + "/ruler", extension);
    fs::remove(named);
    return j;
  } catch (const Error& e) {
    fs::remove(named);
    throw Error(Errc::usage, e.where().empty() ? name : e.where(), e.reason());
  }
}

}  // namespace

void add_upload_routes(Routes& routes, const LabServices& lab) {
  routes.add("POST", "/api/upload",
             [&lab](const auto& r, const auto&) { return json_answer(take_upload(lab, r)); });
  routes.add("POST", "/api/upload/ruler",
             [&lab](const auto& r, const auto&) { return json_answer(take_ruler(lab, r)); });
  routes.add("GET", "/api/uploads/*", [&lab](const auto&, const auto& names) {
    const fs::path file = lab.pictures / names[0];
    if (!fs::exists(file)) throw Error(Errc::input, names[0], "file not found");
    return file_answer(file);
  });
}

}  // namespace faba
