#pragma once

#include <cstdlib>
#include <filesystem>

#include <gtest/gtest.h>

namespace mezzotint::test {

/// Folder of the public measurements that are not part of this repository: MEZZOTINT_TEST_DATA, or
/// shared/data beside the checkout.
inline std::filesystem::path external_data_folder() {
  if (const char* folder = std::getenv("MEZZOTINT_TEST_DATA")) return folder;
  return std::filesystem::path(MEZZOTINT_SOURCE_DIR).parent_path() / "shared" / "data";
}

/// An empty folder of this test's own, removed with everything in it at the end.
class TemporaryFolder {
public:
  TemporaryFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "mezzotint-test-XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr) throw std::runtime_error("no temporary folder");
    path_ = name;
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  [[nodiscard]] std::filesystem::path operator/(const char* name) const { return path_ / name; }
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

private:
  std::filesystem::path path_;
};

}  // namespace mezzotint::test

/// Skips the test, with a message, where a public data file is not at hand.
#define MEZZOTINT_NEEDS_DATA(path)    \
  if (!std::filesystem::exists(path)) \
  GTEST_SKIP() << "needs " << (path) << "; set MEZZOTINT_TEST_DATA to the folder that holds it"
