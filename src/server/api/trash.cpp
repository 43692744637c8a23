#include <cstdlib>

#include "server/api/lab_services.h"
#include "server/api/responses.h"

namespace faba {

Json trash_item_json(const Trash::Item& item) {
  return {{"id", item.id}, {"name", item.name}, {"bytes", item.bytes}};
}

void add_trash_routes(Routes& routes, const LabServices& lab) {
  routes.add("GET", "/api/trash", [&lab](const auto&, const auto&) {
    Json all = Json::array();
    for (const Trash::Item& item : lab.trash.items()) all.push_back(trash_item_json(item));
    return json_answer(all);
  });
  routes.add("POST", "/api/trash/*/undo", [&lab](const auto&, const auto& names) {
    return json_answer(trash_item_json(lab.trash.undo(std::atoi(names[0].c_str()))));
  });
}

}  // namespace faba
