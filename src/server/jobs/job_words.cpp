#include "server/jobs/job_words.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>

#include "core/error.h"
#include "core/units.h"
#include "study/experiment/experiment.h"

namespace faba {
namespace {

using In = JobInput::Kind;
constexpr std::size_t kMostChosen = 200, kMostCurrents = 64, kLongestWords = 200;

bool is_file(const JobInput& i) {
  constexpr In kFiles[] = {In::video,       In::picture, In::frame,     In::table,
                           In::coil_system, In::study,   In::experiment};
  return std::find(std::begin(kFiles), std::end(kFiles), i.kind) != std::end(kFiles);
}

// The value as the user sees it, short enough for a message.
std::string shown(const Json& value) {
  constexpr std::size_t kLongest = 80;
  std::string text = value.is_string() ? value.get<std::string>()
                                       : value.dump(-1, ' ', false, Json::error_handler_t::replace);
  if (text.size() > kLongest) text.resize(kLongest);
  return text;
}

[[noreturn]] void refuse(const JobInput& i, const std::string& what) {
  throw Error(Errc::usage, i.key, what);
}

std::string with_unit(double v, const std::string& unit) {
  return fmt::format("{:.12g}{}{}", v, unit.empty() ? "" : " ", unit);
}
std::string permitted(const JobInput& i) {
  return fmt::format("it must be {} between {} and {}", i.kind == In::integer ? "an integer" : "a number",
                     with_unit(i.min, i.unit), with_unit(i.max, i.unit));
}

// A number or a quantity in the unit of the input. A bare number is in this unit.
double number_of(const JobInput& i, const Json& value) {
  double v = 0;
  if (value.is_number()) {
    v = value.get<double>();
  } else if (value.is_string()) {
    try {
      const Quantity q = parse_quantity(value.get<std::string>());
      const Quantity unit = parse_unit(i.unit.empty() ? "1" : i.unit);
      if (q.dimension != unit.dimension && !q.bare)
        refuse(i, fmt::format("\"{}\" has the wrong unit; {}", shown(value), permitted(i)));
      v = q.bare ? q.value : q.value / unit.value;
    } catch (const std::invalid_argument&) {
      refuse(i, fmt::format("\"{}\" is not a number; {}", shown(value), permitted(i)));
    }
  } else {
    refuse(i, fmt::format("{} is not a number; {}", shown(value), permitted(i)));
  }
  if (!std::isfinite(v)) refuse(i, fmt::format("\"{}\" is not a number; {}", shown(value), permitted(i)));
  // A conversion of units has rounding errors: "0.3 mm" is 300 um.
  const double slack = 1e-9 * std::max(std::abs(i.min), 1e-3);
  if (v < i.min - slack || v > i.max * (1 + 1e-9))
    refuse(i, fmt::format("{} is out of range; {}", shown(value), permitted(i)));
  if (i.kind == In::integer && v != std::floor(v))
    refuse(i, fmt::format("{} is not an integer; {}", shown(value), permitted(i)));
  return v;
}

std::string list_of(const JobInput& i, const Json& value, std::size_t least, std::size_t most,
                    const char* between) {
  if (!value.is_array() || value.size() < least || value.size() > most)
    refuse(i, fmt::format("{} is not a list of {} numbers{}", shown(value),
                          least == most ? std::to_string(least) : fmt::format("1 to {}", most),
                          i.unit.empty() ? "" : " in " + i.unit));
  std::string list;
  for (const Json& one : value)
    list += (list.empty() ? "" : between) + with_unit(number_of(i, one), i.shows_unit ? i.unit : "");
  return list;
}

std::string words_of(const JobInput& i, const Json& value) {
  const auto good = [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) ||
           std::string_view("^/*_-, ").find(c) != std::string_view::npos;
  };
  const std::string text = value.is_string() ? value.get<std::string>() : "";
  if (text.empty() || text.size() > kLongestWords || !std::all_of(text.begin(), text.end(), good))
    refuse(i, fmt::format(
                  "\"{}\" must be words such as x,y,bx: letters, digits and ^ / * _ -, separated by commas",
                  shown(value)));
  std::string joined = text;
  std::erase(joined, ' ');
  return joined;
}

std::string choice_of(const JobInput& i, const Json& value) {
  std::string word = value.is_string() ? value.get<std::string>() : "";
  if (std::find(i.choices.begin(), i.choices.end(), word) == i.choices.end())
    refuse(i, fmt::format("\"{}\" must be one of {}", shown(value), fmt::join(i.choices, ", ")));
  return word;
}

// Whether a page has given a value; an empty input does not count.
bool is_given(const Json& values, const std::string& key) {
  if (!values.contains(key)) return false;
  const Json& v = values[key];
  if (v.is_string()) return !v.get_ref<const std::string&>().empty();
  return !v.is_null() && !(v.is_array() && v.empty());
}

void check_keys(const JobKind& kind, const Json& values) {
  std::string known;
  for (const JobInput& i : kind.inputs) known += (known.empty() ? "" : ", ") + i.key;
  for (const auto& [key, _] : values.items())
    if (std::none_of(kind.inputs.begin(), kind.inputs.end(),
                     [&k = key](const JobInput& i) { return i.key == k; }))
      throw Error(Errc::usage, key.substr(0, 80),
                  fmt::format("is not a value of {}; it must be one of {}", kind.verb_text(), known));
}

// With "./" a name that starts with a dash does not become an option. Files of allowed folders have absolute
// paths.
std::string word_of_file(const std::string& file) { return file.starts_with('/') ? file : "./" + file; }
// The inverse of word_of_file(); empty for another word.
std::string file_of_word(const std::string& word) {
  return word.starts_with('/') ? word : word.starts_with("./") ? word.substr(2) : "";
}

// Throws Error(usage) if an experiment has a video that pages may not read. An invalid file is reported by
// the job.
void check_experiment(const std::filesystem::path& path, const Workspace& workspace) {
  const auto file = experiment_file(path);
  if (!file) return;
  Experiment e;
  try {
    e = read_experiment(*file);
  } catch (const Error&) {
    return;
  }
  if (!e.noise.empty()) e.videos.emplace_back().file = e.noise;
  for (const ExperimentVideo& v : e.videos)
    if (!workspace.may_read(video_path(*file, v)))
      throw Error(Errc::usage, v.file,
                  "is neither in the folder in which the lab was started nor in a folder given by --allow");
}

// Whether a word after the verb is one that job_words() makes.
bool is_word_of(const JobKind& kind, const std::string& word, const Job& job, const Workspace& workspace) {
  if (word == "--json") return true;
  const auto equals = word.starts_with("--") ? word.find('=') : word.npos;
  const std::string option = equals == word.npos ? "" : word.substr(0, equals);
  const std::string value = equals == word.npos ? word : word.substr(equals + 1);
  for (const JobOutput& o : kind.outputs)
    if (!option.empty() && o.option == option) return value == (job.out / o.file).string();
  for (const JobInput& i : kind.inputs) {
    if (i.kind == In::flag && word == i.option) return true;
    if (i.option != option || i.kind == In::flag) continue;
    if (!is_file(i)) return !option.empty();
    if (file_of_word(value).empty()) continue;
    (void)files_of(i, file_of_word(value), workspace);
    return true;
  }
  return false;
}

}  // namespace

void check_job(const Job& job, const Workspace& workspace) {
  if (!job.out.empty()) (void)workspace.inside(job.out.string());
  if (job.kind.empty()) {
    for (const std::string& word : job.words)
      if (!file_of_word(word).empty()) (void)workspace.existing(file_of_word(word));
    return;
  }
  const JobKind& kind = job_kind(job.kind);
  const std::size_t verb = kind.verb.size();
  bool good = job.words.size() > verb && std::equal(kind.verb.begin(), kind.verb.end(), job.words.begin());
  for (std::size_t k = verb; good && k < job.words.size(); ++k)
    good = is_word_of(kind, job.words[k], job, workspace);
  if (!good)
    throw Error(Errc::usage, job.title, "its command was changed outside of the lab; start a new job");
}

std::string word_of(const JobInput& i, const Json& value) {
  switch (i.kind) {
    case In::direction: {
      // y points up for the page and down for the command.
      const double clockwise = std::fmod(720 - number_of(i, value), 360);
      return fmt::format("{:.12g}", clockwise);
    }
    case In::point:
      return list_of(i, value, 2, 2, ", ");
    case In::currents:
      return list_of(i, value, 1, kMostCurrents, ",");
    case In::choice:
      return choice_of(i, value);
    case In::words:
      return words_of(i, value);
    default:
      return with_unit(number_of(i, value), i.shows_unit ? i.unit : "");
  }
}

std::vector<std::string> files_of(const JobInput& i, const Json& value, const Workspace& workspace) {
  const Json list = i.many && value.is_array() ? value : Json::array({value});
  if (list.size() > kMostChosen)
    refuse(i, fmt::format("{} files are too many; choose at most {}", list.size(), kMostChosen));
  std::vector<std::string> files;
  for (const Json& one : list) {
    if (!one.is_string())
      refuse(i, fmt::format("{} is not a file name; choose a file of the list", shown(one)));
    const std::string name = one.get<std::string>();
    try {
      const std::filesystem::path path = workspace.existing(name);
      if (i.kind == In::experiment) check_experiment(path, workspace);
    } catch (const Error& e) {
      refuse(i, e.what());
    }
    files.push_back(name);
  }
  return files;
}

std::vector<std::string> job_words(const JobKind& kind, const Json& values, const Workspace& workspace,
                                   const std::filesystem::path& folder) {
  if (!values.is_object()) throw Error(Errc::usage, "values", "must be a table of values");
  check_keys(kind, values);
  std::vector<std::string> words = kind.verb, options;
  for (const JobInput& i : kind.inputs) {
    if (!is_given(values, i.key)) {
      if (i.required)
        refuse(i, is_file(i) ? "missing; choose a file of the list" : "missing; " + permitted(i));
      continue;
    }
    const Json& value = values[i.key];
    if (is_file(i)) {
      for (const std::string& file : files_of(i, value, workspace))
        if (i.option.empty())
          words.push_back(word_of_file(file));
        else
          options.push_back(i.option + "=" + word_of_file(file));
    } else if (i.kind == In::flag) {
      if (!value.is_boolean()) refuse(i, fmt::format("{} must be true or false", shown(value)));
      if (value.get<bool>()) options.push_back(i.option);
    } else {
      options.push_back(i.option + "=" + word_of(i, value));
    }
  }
  for (const JobOutput& o : kind.outputs) options.push_back(o.option + "=" + (folder / o.file).string());
  words.insert(words.end(), options.begin(), options.end());
  words.emplace_back("--json");
  return words;
}

}  // namespace faba
