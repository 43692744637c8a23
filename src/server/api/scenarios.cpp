#include "app/scenario/scenario_schema.h"
#include "core/error.h"
#include "server/api/lab_services.h"
#include "server/api/responses.h"
#include "server/request_values.h"
#include "server/scenarios/scenario_check.h"

namespace faba {
namespace {

Json check(const LabServices& lab, const Json& asked) {
  Document d;
  try {
    if (asked.contains("toml"))
      d = parse_toml(text_of(asked, "toml"), file_name_of(asked));
    else if (asked.contains("scenario") && asked["scenario"].is_object())
      d = lab.workspace.page_document(asked["scenario"]);
    else
      throw Error(Errc::usage, "scenario", "missing; it must be an object");
    lab.workspace.check_files(d.root);
    return scenario_check(d, lab.parts, lab.workspace.root());
  } catch (const Error& e) {
    return {{"ok", false}, {"where", lab.workspace.in_page(e.where())}, {"what", e.reason()}};
  }
}

}  // namespace

void add_scenario_routes(Routes& routes, const LabServices& lab) {
  routes.add("GET", "/api/schema",
             [&lab](const auto&, const auto&) { return json_answer(scenario_json_schema(lab.parts)); });
  routes.add("POST", "/api/check",
             [&lab](const auto& r, const auto&) { return json_answer(check(lab, body_of(r))); });
}

}  // namespace faba
