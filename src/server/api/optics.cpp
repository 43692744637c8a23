#include "server/api/lab_services.h"
#include "server/api/responses.h"
#include "server/request_values.h"
#include "study/pages/optics_report.h"

namespace faba {

void add_optics_routes(Routes& routes) {
  routes.add("GET", "/api/optics",
             [](const auto&, const auto&) { return json_answer(OpticsSetup::schema().json_schema()); });
  routes.add("POST", "/api/optics", [](const auto& r, const auto&) {
    Document d;
    d.root = body_of(r);
    return json_answer(optics_json(OpticsSetup::schema().parse(Node(d))));
  });
}

}  // namespace faba
