#include "app/scenario/event.h"

namespace faba {

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

}  // namespace faba
