#pragma once

#include <cstdint>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <string_view>

namespace mezzotint {

/// Exit status of the program; every kind of error has one.
enum class ExitStatus : int {
  Done = 0,
  Failed = 1,          ///< the work could not be done: a device, a disk, a method that does not apply
  BadInput = 2,        ///< usage, configuration or an input file
  ToleranceMissed = 3  ///< done, but a tolerance that the user stated was not met
};

/// Root of the errors that cross Mezzotint's public functions.
class Error : public std::runtime_error {
public:
  Error(const std::string& message, ExitStatus status) : std::runtime_error(message), status_(status) {}
  [[nodiscard]] ExitStatus status() const { return status_; }

private:
  ExitStatus status_;
};

/// The caller asked for something that makes no sense: a negative pitch, an unknown key, an empty mask.
class InvalidInput : public Error {
public:
  explicit InvalidInput(const std::string& message) : Error(message, ExitStatus::BadInput) {}
};

/// A file's content cannot be used. The message reads "path: place: what is wrong; what would be right".
class FileError : public Error {
public:
  /// @param place  where in the file ("byte 1261", "line 7", "main.xml"), or empty for the whole of it.
  FileError(const std::filesystem::path& path, std::string_view place, std::string_view problem);
};

/// Something outside of the program failed: a disk that is full, a printer that does not answer.
class DeviceError : public Error {
public:
  explicit DeviceError(const std::string& message) : Error(message, ExitStatus::Failed) {}
};

/// A method was taken to a place where it does not hold, or ended without a usable answer.
class MethodError : public Error {
public:
  explicit MethodError(const std::string& message) : Error(message, ExitStatus::Failed) {}
};

/// The user asked to stop (Ctrl-C). What is finished is on disk and can be resumed.
class Interrupted : public Error {
public:
  Interrupted()
      : Error("interrupted; run and design go on with --resume, and so does what was started with --resume",
              ExitStatus::Failed) {}
};

/// Checks a caller's data, before anything is allocated for it.
/// @throws InvalidInput with `message` where the condition does not hold.
inline void require(bool condition, const std::string& message) {
  if (!condition) throw InvalidInput(message);
}
inline void require(bool condition, const char* message) {
  if (!condition) throw InvalidInput(message);
}

}  // namespace mezzotint
