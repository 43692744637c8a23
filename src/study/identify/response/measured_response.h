#pragma once
#include <filesystem>
#include <functional>
#include <vector>

#include "study/identify/identify_study.h"
#include "study/identify/legacy_selection.h"
#include "study/sweep/sweep.h"

namespace faba {

/// The measured videos of a study, as survey_response() returns them. Measurements that are stored in
/// `options.measured` are not repeated. `reading` as in identify(). Throws the errors of survey_response(),
/// and Error(interrupted) when stopped.
std::vector<ResponseVideo> measured_responses(const IdentifyStudy& study, const SweepOptions& options,
                                              const std::function<void()>& reading);

/// The measured videos of a study, all from the folder `measured`. Throws Error(input) when one is missing.
std::vector<ResponseVideo> stored_responses(const IdentifyStudy& study,
                                            const std::filesystem::path& measured);

/// The references of the rule of the thesis, stored in the same way.
LegacyReferences measured_references(const IdentifyStudy& study, const std::vector<ResponseVideo>& videos,
                                     const SweepOptions& options, const std::function<void()>& reading);

/// Tasks of a round of the study from its description, for a process that does not read the videos:
/// everything is in the folder `measured`. Throws Error(input) when a measurement is missing.
Round planned_simulations(const IdentifyStudy& study, const std::filesystem::path& measured,
                          const std::string& description);

}  // namespace faba
