#include "server/api/lab_services.h"
#include "server/api/responses.h"
#include "server/request_values.h"
#include "study/experiment/experiment.h"

namespace faba {

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
}

}  // namespace faba
