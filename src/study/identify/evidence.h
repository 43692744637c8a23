#pragma once
#include "study/identify/identification.h"

namespace faba {

/// Selects the best model and rates the evidence for it. It is "clear" only for a model that explains the
/// videos, and only if no other model does so when it is extended by one of its families. Throws Error(input)
/// if no model could be identified.
void judge(Identification& result);

}  // namespace faba
