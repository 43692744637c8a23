#include <algorithm>

#include "core/error.h"
#include "server/api/lab_services.h"
#include "server/api/responses.h"
#include "server/files/file_kinds.h"
#include "server/request_values.h"

namespace faba {
namespace {

namespace fs = std::filesystem;
constexpr std::size_t kMostEntries = 2000;

Json folder_json(const LabServices& lab, const fs::path& folder) {
  return {{"name", folder.filename()}, {"path", lab.workspace.name_of(folder)}};
}

// The workspace and the allowed folders.
Json top(const LabServices& lab) {
  Json folders = Json::array({{{"name", lab.workspace.root().filename()}, {"path", "."}}});
  for (const fs::path& folder : lab.workspace.allowed())
    folders.push_back({{"name", folder.string()}, {"path", folder.string()}});
  return {{"path", ""}, {"parent", nullptr}, {"folders", folders}, {"files", Json::array()}};
}

bool is_top(const LabServices& lab, const fs::path& folder) {
  return folder == lab.workspace.root() ||
         std::ranges::find(lab.workspace.allowed(), folder) != lab.workspace.allowed().end();
}

// Folders, and files with frames by their extension; without hidden ones and links to other places.
Json list(const LabServices& lab, const std::string& path) {
  const fs::path folder = path == "." ? lab.workspace.root() : lab.workspace.existing(path);
  if (!fs::is_directory(folder)) throw Error(Errc::usage, path, "is not a folder");
  std::vector<fs::path> entries;
  std::error_code ec;
  for (const auto& e : fs::directory_iterator(folder, fs::directory_options::skip_permission_denied, ec))
    if (entries.size() < kMostEntries && lab.workspace.may_read(e.path())) entries.push_back(e.path());
  std::sort(entries.begin(), entries.end());
  Json folders = Json::array(), files = Json::array();
  for (const fs::path& e : entries) {
    if (fs::is_directory(e, ec))
      folders.push_back(folder_json(lab, e));
    else if (has_video_extension(e) || has_picture_extension(e))
      files.push_back(
          {{"name", e.filename()}, {"path", lab.workspace.name_of(e)}, {"bytes", fs::file_size(e, ec)}});
  }
  const std::string parent = is_top(lab, folder) ? "" : lab.workspace.name_of(folder.parent_path());
  return {
      {"path", lab.workspace.name_of(folder)}, {"parent", parent}, {"folders", folders}, {"files", files}};
}

}  // namespace

void add_folder_routes(Routes& routes, const LabServices& lab) {
  routes.add("GET", "/api/folders", [&lab](const auto& r, const auto&) {
    const std::string path = query_text(r, "path");
    return json_answer(path.empty() ? top(lab) : list(lab, path));
  });
}

}  // namespace faba
