#include "study/data/kept_flows.h"

#include <utility>

namespace faba {
namespace {

std::size_t bytes_of(const Flow& flow) { return (flow.u.px.size() + flow.v.px.size()) * sizeof(float); }

}  // namespace

void KeptFlows::keep(std::uint64_t frame, const Flow& flow) {
  const std::lock_guard lock(mutex_);
  if (bytes_ + bytes_of(flow) > kBytes) return;
  if (flows_.emplace(frame, flow).second) bytes_ += bytes_of(flow);
}

std::optional<Flow> KeptFlows::take(std::uint64_t frame) {
  const std::lock_guard lock(mutex_);
  const auto found = flows_.find(frame);
  if (found == flows_.end()) return {};
  Flow flow = std::move(found->second);
  bytes_ -= bytes_of(flow);
  flows_.erase(found);
  return flow;
}

}  // namespace faba
