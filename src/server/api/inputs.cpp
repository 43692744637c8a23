#include "server/api/lab_services.h"
#include "server/api/responses.h"
#include "server/jobs/input_files.h"

namespace faba {

void add_input_routes(Routes& routes, const LabServices& lab) {
  routes.add("GET", "/api/inputs",
             [&lab](const auto&, const auto&) { return json_answer(input_files(lab.workspace)); });
}

}  // namespace faba
