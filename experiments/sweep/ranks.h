#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "forward/base/error.h"
#include "forward/base/progress.h"

namespace mezzotint {

/// The processes that do one piece of work together, where the program was started by mpirun or srun; else this process
/// alone, and MPI is not touched. Made once, in `main`.
///
/// Threads  all calls from the thread that made it.
class Ranks {
public:
  /// Starts MPI where the environment says that a launcher started this process (OMPI_COMM_WORLD_SIZE, PMI_SIZE,
  /// PMIX_RANK) and the program was built with MPI.
  /// @throws MethodError where a launcher started several processes of a program that was built without MPI: each
  ///         would do all of the work.
  Ranks();
  /// Ends MPI; waits for the other ranks to come to the same point.
  ~Ranks();
  Ranks(const Ranks&) = delete;
  Ranks& operator=(const Ranks&) = delete;

  [[nodiscard]] int rank() const;
  [[nodiscard]] int count() const;
  /// Rank 0: the one that shows progress, prints results and writes files.
  [[nodiscard]] bool is_first() const { return rank() == 0; }

  /// Call it where this rank's work ended with an error: the others stop too, in their next or present sweep.
  void stop_others(const std::string& why, ExitStatus status);

private:
  friend class Sweep;
  struct Link;
  std::unique_ptr<Link> link_;
};

/// Another rank failed, and has said why, or rank 0 will: nothing more needs to be said here.
class StoppedByOtherRank : public Error {
public:
  explicit StoppedByOtherRank(ExitStatus status) : Error("stopped, since another rank failed", status) {}
};

/// A task of a sweep: its result as bytes. It is called from any thread, by any rank, in any order: the result must
/// depend on the index alone.
using SweepTask = std::function<std::string(std::size_t index)>;

/// Does tasks 0 … count − 1 on all ranks and all threads, each rank taking some when it has none left, and returns the
/// results in the order of the indices: the same bits for any number of ranks and threads. On ranks other than 0 the
/// list is empty.
/// @param name      of a task, for the note of the progress; may be empty
/// @param progress  called on rank 0 alone
/// @throws what a task throws, on rank 0 as the same kind of status with the rank's number in the message; on the
///         other ranks StoppedByOtherRank. A rank that fails makes all of them stop after their present tasks.
[[nodiscard]] std::vector<std::string> sweep(Ranks& ranks, std::size_t count, const SweepTask& task,
                                             const Progress& progress, const std::string& stage,
                                             const std::function<std::string(std::size_t)>& name = {});

/// Lists of numbers as bytes, and back: their exact bits.
[[nodiscard]] std::string bytes_of(const std::vector<double>& values);
/// @throws InvalidInput for bytes that are no whole number of doubles.
[[nodiscard]] std::vector<double> doubles_of(const std::string& bytes);

}  // namespace mezzotint
