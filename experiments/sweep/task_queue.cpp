#include "experiments/sweep/task_queue.h"

#include <algorithm>

#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

namespace mezzotint {

namespace {

std::size_t usable_threads() {
  const auto limit = tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
  return std::clamp<std::size_t>(static_cast<std::size_t>(tbb::this_task_arena::max_concurrency()), 1,
                                 std::max<std::size_t>(1, limit));
}

}  // namespace

TaskQueue::TaskQueue(const SweepTask& task)
    : task_(task), threads_(usable_threads()), thread_([this] {
        tbb::parallel_for(
            std::size_t{0}, threads_, [this](std::size_t) { work(); }, tbb::simple_partitioner());
      }) {}

TaskQueue::~TaskQueue() {
  drop();
  join();
}

void TaskQueue::add(std::size_t index) {
  const std::lock_guard lock(mutex_);
  waiting_.push_back(index);
  ++outstanding_;
  changed_.notify_one();
}

void TaskQueue::close() {
  const std::lock_guard lock(mutex_);
  closed_ = true;
  changed_.notify_all();
}

void TaskQueue::drop() {
  const std::lock_guard lock(mutex_);
  closed_ = true;
  outstanding_ -= waiting_.size();
  waiting_.clear();
  changed_.notify_all();
}

void TaskQueue::join() {
  if (thread_.joinable()) thread_.join();
}

std::size_t TaskQueue::outstanding() const {
  const std::lock_guard lock(mutex_);
  return outstanding_;
}

std::vector<std::pair<std::size_t, std::string>> TaskQueue::take_results() {
  const std::lock_guard lock(mutex_);
  outstanding_ -= results_.size();
  return std::exchange(results_, {});
}

std::exception_ptr TaskQueue::failure() const {
  const std::lock_guard lock(mutex_);
  return failure_;
}

void TaskQueue::work() {
  for (std::size_t index = 0; take(index);) do_one(index);
}

bool TaskQueue::take(std::size_t& index) {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return closed_ || !waiting_.empty(); });
  if (waiting_.empty()) return false;
  index = waiting_.front();
  waiting_.pop_front();
  return true;
}

void TaskQueue::do_one(std::size_t index) {
  std::string result;
  std::exception_ptr thrown;
  try {
    // Without it a thread that waits inside of a task could pick up another one, and keep the first from ending.
    tbb::this_task_arena::isolate([&] { result = task_(index); });
  } catch (...) {
    thrown = std::current_exception();
  }
  const std::lock_guard lock(mutex_);
  if (!thrown) {
    results_.emplace_back(index, std::move(result));
    return;
  }
  --outstanding_;
  if (!failure_) failure_ = thrown;
}

}  // namespace mezzotint
