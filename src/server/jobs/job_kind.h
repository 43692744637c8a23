#pragma once
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "core/toml.h"

namespace faba {

/// A value that a job needs, as a page asks for it and as a command has it.
struct JobInput {
  enum class Kind {
    video,        ///< a video, a folder of pictures or a run with a camera video
    picture,      ///< a picture
    frame,        ///< a picture or a video, of which the first frame is used
    table,        ///< a text or HDF5 file with numbers
    coil_system,  ///< a coil system file
    study,        ///< a study file of the verb
    experiment,   ///< a folder with an experiment file
    number,
    integer,
    point,      ///< two quantities, x and y
    currents,   ///< a list of quantities, one for each coil
    direction,  ///< in the picture, counter-clockwise, y up, deg; the command counts clockwise
    choice,
    flag,
    words  ///< a list of words such as "z,b": letters, digits and `^/*_-`, separated by commas
  };
  std::string key;
  Kind kind = Kind::number;
  std::string option = {};  ///< "--reversal"; empty: an argument without an option
  bool required = false;
  bool many = false;        ///< several files
  std::string unit = {};    ///< unit of a quantity, as the command shows it; empty: a number
  bool shows_unit = false;  ///< the option needs the unit with the number: "10 um"
  double min = -std::numeric_limits<double>::max();  ///< in `unit`
  double max = std::numeric_limits<double>::max();   ///< in `unit`
  std::vector<std::string> choices = {};
  std::string doc = {};  ///< one sentence
};

/// A file that a job writes into its folder.
struct JobOutput {
  std::string option;  ///< "--report"; "--out" of a study has the folder itself
  std::string file;    ///< "report.html"; empty: the folder
};

/// What decides the run time of a job; see work_of().
enum class JobWork {
  fixed,        ///< the same for every job
  pixels,       ///< frames times pixels of the videos
  simulations,  ///< frames times pixels of all simulations of a study
  cell_frames,  ///< frames times cells of all trials of a study
  sets          ///< sets of currents
};

/// The study files of a verb that a page can compose; see compose_study().
enum class JobStudy { none, identification, controllers };

/// A kind of job: one command of the program, with everything that a page needs to offer it.
struct JobKind {
  std::string name;               ///< "field-map": in addresses
  std::string group;              ///< "videos", "models", "control" or "coils"
  std::vector<std::string> verb;  ///< {"field", "map"}
  std::string doc;
  std::vector<JobInput> inputs = {};
  std::vector<JobOutput> outputs = {};
  std::string page = {};  ///< file that shows the result; empty: the values that the command prints
  JobWork work = JobWork::fixed;
  JobStudy study = JobStudy::none;
  /// Initial estimate, until jobs of this kind are complete: a constant part, and one in proportion to the
  /// work. Assumed, see job_kinds.cpp.
  double fixed_s = 1, s_per_work = 0;

  std::string verb_text() const;  ///< "field map"
};

/// All kinds, in the order of the page.
const std::vector<JobKind>& job_kinds();
/// The kind of this name. Throws Error(usage) with the known names.
const JobKind& job_kind(std::string_view name);

/// A kind as the page needs it: "kind", "group", "verb", "page", and "schema" of its values, a JSON Schema as
/// that of a scenario. `x-file` of a property is the kind of file (InputFile), `x-direction` marks a
/// direction in the picture, and `x-currents` a list of currents.
Json job_kind_json(const JobKind& kind);

}  // namespace faba
