#include <fmt/format.h>

#include <atomic>

#include "core/error.h"
#include "server/api/lab_services.h"
#include "server/api/responses.h"
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

}  // namespace

void add_upload_routes(Routes& routes, const LabServices& lab) {
  routes.add("POST", "/api/upload",
             [&lab](const auto& r, const auto&) { return json_answer(take_upload(lab, r)); });
  routes.add("GET", "/api/uploads/*", [&lab](const auto&, const auto& names) {
    const fs::path file = lab.pictures / names[0];
    if (!fs::exists(file)) throw Error(Errc::input, names[0], "file not found");
    return file_answer(file);
  });
}

}  // namespace faba
