#pragma once
#include <string>

#include <nlohmann/json_fwd.hpp>

#include "study/calibrate/calibration.h"
#include "study/data/provenance.h"

namespace faba {

/// The result of `faba calibrate` as JSON, and as a self-contained HTML page.
nlohmann::ordered_json calibration_json(const StudyCalibration& c);
std::string calibration_page(const StudyCalibration& c, const Provenance& provenance);

/// For the page of `identify`: the calibration of the study that its key `calibration` names, or a warning
/// that the study is not calibrated.
std::string calibration_note(const IdentifyStudy& study);

}  // namespace faba
