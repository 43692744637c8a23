#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "server/jobs/job.h"
#include "server/jobs/job_kind.h"
#include "server/workspace.h"

namespace faba {

/// A value of a page as one word of a command: a number in the unit of the input ("0.5"), with the unit where
/// the option needs it ("10 um"), a direction clockwise from the right as the command counts, or a word of
/// the choices. Throws Error(usage) with the key, the value and what is permitted.
std::string word_of(const JobInput& input, const Json& value);

/// The files that a page chose for an input, relative to the workspace. Throws Error(usage) with the key for
/// values that are not names of existing files inside the workspace.
std::vector<std::string> files_of(const JobInput& input, const Json& value, const Workspace& workspace);

/// The words of the command for values of a page; outputs go to `folder`, relative to the workspace. Files
/// begin with "./" and values are joined to their option, so that no value can become an option. Throws
/// Error(usage) with the key of a value that is missing, unknown or invalid.
std::vector<std::string> job_words(const JobKind& kind, const Json& values, const Workspace& workspace,
                                   const std::filesystem::path& folder);

/// Throws Error if the command of a job is not one that the lab makes, or if its files are not (any more) in
/// the workspace or in an allowed folder: job files in the workspace may come from elsewhere, and folders may
/// change while a job is queued.
void check_job(const Job& job, const Workspace& workspace);

}  // namespace faba
