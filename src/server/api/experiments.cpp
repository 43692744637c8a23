#include <fmt/format.h>

#include <algorithm>

#include "core/error.h"
#include "server/api/imported_videos.h"
#include "server/api/lab_services.h"
#include "server/api/responses.h"
#include "server/request_values.h"
#include "study/experiment/experiment.h"

namespace faba {
namespace {

ImportPart part_of(const WebRequest& r) {
  return {.name = query_text(r, "name"),
          .size = query_count(r, "size", 0),
          .offset = query_count(r, "offset", 0),
          .modified_s = std::int64_t(query_count(r, "modified", 0)),
          .drop = query_text(r, "drop")};
}

// Adds a video of the workspace or of an allowed folder where it is.
Json pick(const LabServices& lab, const std::string& name, const Json& asked) {
  const std::filesystem::path file = lab.workspace.existing(text_of(asked, "file"));
  const std::filesystem::path folder = lab.experiments.folder(name);
  const bool outside = lab.workspace.name_of(file).starts_with('/');
  const std::string path = outside ? file.string() : file.lexically_relative(folder).string();
  lab.experiments.add_video(name, path, asked.value("drop", ""));
  return {{"file", path}};
}

}  // namespace

void add_experiment_routes(Routes& routes, const LabServices& lab) {
  routes.add("GET", "/api/experiments",
             [&lab](const auto&, const auto&) { return json_answer(lab.experiments.list()); });
  routes.add("GET", "/api/schema/experiment",
             [](const auto&, const auto&) { return json_answer(experiment_schema()); });
  routes.add("POST", "/api/experiments", [&lab](const auto& r, const auto&) {
    return json_answer({{"name", lab.experiments.create(text_of(body_of(r), "title"))}});
  });
  routes.add("GET", "/api/experiments/*",
             [&lab](const auto&, const auto& names) { return json_answer(lab.experiments.read(names[0])); });
  routes.add("POST", "/api/experiments/*", [&lab](const auto& r, const auto& names) {
    return json_answer(lab.experiments.change(names[0], body_of(r)));
  });
  routes.add("POST", "/api/experiments/*/videos", [&lab](const auto& r, const auto& names) {
    return json_answer(pick(lab, names[0], body_of(r)));
  });
  routes.add("GET", "/api/experiments/*/videos", [&lab](const auto& r, const auto& names) {
    return json_answer(describe_imported_video(lab, names[0], query_text(r, "file")));
  });
  routes.add("DELETE", "/api/experiments/*/videos", [&lab](const auto& r, const auto& names) {
    return json_answer(trash_item_json(remove_imported_video(lab, names[0], query_text(r, "file"))));
  });
  routes.add("GET", "/api/experiments/*/imports", [&lab](const auto& r, const auto& names) {
    if (!r.query.contains("name")) return json_answer(lab.imports.incomplete(names[0]));
    return json_answer(
        {{"received", lab.imports.received(names[0], query_text(r, "name"), query_count(r, "size", 0))}});
  });
  routes.add("POST", "/api/experiments/*/imports", [&lab](const auto& r, const auto& names) {
    return json_answer(lab.imports.take(names[0], part_of(r), r.body));
  });
  routes.add("DELETE", "/api/experiments/*/imports", [&lab](const auto& r, const auto& names) {
    lab.imports.cancel(names[0], query_text(r, "name"), query_count(r, "size", 0));
    return json_answer(Json::object());
  });
}

}  // namespace faba
