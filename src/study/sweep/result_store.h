#pragma once
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace faba {

class OutputFile;

/// Results of the tasks of a study, kept in a file as they come: one line of JSON for each, written straight
/// through, so that whatever ends the program loses none that was added. A last line that a power cut left
/// half written is dropped.
class ResultStore {
 public:
  /// Opens `file`, or makes it. Throws Error(input, "file:line") for lines that are no results,
  /// Error(internal) when it cannot be written.
  explicit ResultStore(const std::filesystem::path& file);
  ~ResultStore();

  /// The result of the task of this key, or null.
  bool empty() const { return results_.empty(); }
  const std::vector<double>* find(const std::string& key) const;
  /// Keeps a result; one that is there already stays as it is. Numbers may be NaN.
  void add(const std::string& key, const std::vector<double>& values);
  /// Takes over what the store in another file holds. Throws Error(input) when there is none.
  void merge(const std::filesystem::path& file);
  std::size_t size() const { return results_.size(); }

 private:
  std::uint64_t read(const std::filesystem::path& file);

  std::map<std::string, std::vector<double>> results_;
  std::unique_ptr<OutputFile> file_;
};

}  // namespace faba
