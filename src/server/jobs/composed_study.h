#pragma once
#include <string>

#include "server/jobs/job_kind.h"
#include "server/workspace.h"

namespace faba {

/// A study that a page composed, as a file.
struct ComposedStudy {
  std::string file;  ///< "studies/slow.toml", relative to the workspace
  std::string toml;
  double work = 0;  ///< see work_of_study()
};

/// Writes a study of a page for `identify` or `compare-controllers`. `asked`: "name" of the file, "folder" of
/// an experiment (default: the workspace), and "study": the keys of a study file as JSON, but files are
/// relative to the workspace, and directions are counter-clockwise with y up, in degrees. The study goes to
/// studies/NAME.toml of the folder; a number is added to a name that another study has. With "draft": true,
/// the study is checked and nothing stays. Throws Error(usage) with the key of an invalid value.
ComposedStudy compose_study(const JobKind& kind, const Json& asked, const Workspace& workspace);

}  // namespace faba
