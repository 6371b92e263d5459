#pragma once

#include <condition_variable>
#include <deque>
#include <exception>
#include <mutex>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "experiments/sweep/ranks.h"

/// Inside of experiments/sweep.

namespace mezzotint {

/// Tasks that this process does on all its threads while the thread that made it talks to other ranks and shows
/// progress.
class TaskQueue {
public:
  explicit TaskQueue(const SweepTask& task);
  /// Ends as `drop`, and waits.
  ~TaskQueue();
  TaskQueue(const TaskQueue&) = delete;
  TaskQueue& operator=(const TaskQueue&) = delete;

  [[nodiscard]] std::size_t threads() const { return threads_; }
  void add(std::size_t index);
  /// No more will be added: threads end when they have none left.
  void close();
  /// Tasks that have not begun are left out.
  void drop();
  /// Waits until no task runs; after `close` or `drop`.
  void join();

  /// Tasks that were added and whose results nobody took yet.
  [[nodiscard]] std::size_t outstanding() const;
  /// Those that are done: their results, in no order.
  [[nodiscard]] std::vector<std::pair<std::size_t, std::string>> take_results();
  /// The first exception of a task; null for none.
  [[nodiscard]] std::exception_ptr failure() const;

private:
  void work();
  [[nodiscard]] bool take(std::size_t& index);
  void do_one(std::size_t index);

  const SweepTask& task_;
  std::size_t threads_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<std::size_t> waiting_;
  std::vector<std::pair<std::size_t, std::string>> results_;
  std::exception_ptr failure_;
  std::size_t outstanding_ = 0;
  bool closed_ = false;
  std::thread thread_;
};

}  // namespace mezzotint
