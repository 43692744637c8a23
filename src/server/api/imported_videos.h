#pragma once
#include <string>

#include "server/api/lab_services.h"

namespace faba {

/// What the removal of a video from an experiment would delete: "file", whether it was "imported" (its file
/// is in the folder videos/ of the experiment; other files are never deleted), its "bytes", and "used_by",
/// the names of other experiments that use the file, and of this one if it measures the noise. Throws
/// Error(input) if the experiment has no such video.
Json describe_imported_video(const LabServices& lab, const std::string& experiment, const std::string& file);

/// Moves the file of an imported video to the trash and removes its entry; one undo restores both. Throws
/// Error(usage) for a file that was not imported, is used by another experiment, or by a job that has not
/// ended.
Trash::Item remove_imported_video(const LabServices& lab, const std::string& experiment,
                                  const std::string& file);

}  // namespace faba
