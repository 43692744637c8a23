#include "app/scenario/event.h"

namespace faba {

Schema<EventTime> EventTime::schema() {
  return Schema<EventTime>("event", "Parts that are exchanged during the run")
      .add("frame", &EventTime::frame,
           {.min = 0, .max = 1e9, .doc = "The exchange takes place before this frame; the first frame is 0"})
      .add("swarm", &EventTime::swarm,
           {.min = 0, .max = 1e6, .doc = "Index of the swarm whose model is exchanged, from 0"});
}

Json Event::resolved() const {
  Json j = {{"frame", frame}};
  if (model) {
    j["swarm"] = swarm;
    j["model"] = model->resolved;
  }
  if (estimator) j["estimator"] = estimator->resolved;
  if (reference) j["reference"] = reference->resolved;
  if (controller) j["controller"] = controller->resolved;
  return j;
}

Json events_json(const std::vector<Event>& events) {
  if (events.empty()) return {};
  Json all = Json::array();
  for (const Event& e : events) all.push_back(e.resolved());
  return all;
}

Json events_json_schema(const Parts& parts) {
  Json one = EventTime::schema().json_schema();
  one["properties"]["estimator"] = parts.estimator.json_schema_of_choice();
  one["properties"]["reference"] = parts.reference.json_schema_of_choice();
  one["properties"]["controller"] = parts.controller.json_schema_of_choice();
  one["properties"]["model"] = parts.model.json_schema_of_choice();
  return {{"type", "array"}, {"items", one}};
}

}  // namespace faba
