#pragma once
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace faba {

class OutputFile;

/// Results of the tasks of a study, stored in a file with one line of JSON per result. Each line is written
/// immediately, so that no result is lost when the program ends. An incomplete last line, as after a power
/// failure, is dropped.
class ResultStore {
 public:
  /// Opens or creates `file`. Throws Error(input, "file:line") for lines that are not results,
  /// Error(internal) when it cannot be written.
  explicit ResultStore(const std::filesystem::path& file);
  ~ResultStore();

  /// Whether there are no results.
  bool empty() const { return results_.empty(); }
  /// The result of the task with this key, or null.
  const std::vector<double>* find(const std::string& key) const;
  /// Stores a result; an existing result is not changed. Values may be NaN.
  void add(const std::string& key, const std::vector<double>& values);
  /// Adds the results of the store in another file. Throws Error(input) when the file does not exist.
  void merge(const std::filesystem::path& file);
  std::size_t size() const { return results_.size(); }

 private:
  std::uint64_t read(const std::filesystem::path& file);

  std::map<std::string, std::vector<double>> results_;
  std::unique_ptr<OutputFile> file_;
};

}  // namespace faba
