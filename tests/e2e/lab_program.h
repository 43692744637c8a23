#pragma once
#include <fstream>
#include <string>

#include "core/file.h"
#include "tests/e2e/child.h"
#include "tests/rig/devices.h"
#include "tests/server/lab_access.h"
#include "tests/temporary_folder.h"

namespace faba::test {

/// `faba lab` as a separate process, as a user starts it: the guard of the coils is beside the program. The
/// destructor kills it.
class LabProgram : public LabAccess {
 public:
  explicit LabProgram(const std::filesystem::path& folder) : folder_(folder) {
    std::filesystem::create_directories(folder / "scenes");
  }
  void start() {
    process_ =
        std::make_unique<Child>(folder_, "'" FABA_PROGRAM "' lab --no-browser > address.txt 2> lab.txt");
    REQUIRE(soon([&] {
      std::ifstream in(folder_ / "address.txt");
      std::string line;
      if (std::getline(in, line) && !in.eof()) read_address(line);
      return port != 0;
    }));
  }
  Child& process() { return *process_; }
  const std::filesystem::path& folder() const { return folder_; }

 private:
  std::filesystem::path folder_;
  std::unique_ptr<Child> process_;
};

}  // namespace faba::test
