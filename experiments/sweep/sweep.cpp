#include <algorithm>
#include <chrono>
#include <optional>
#include <set>

#include <fmt/format.h>

#include "experiments/sweep/rank_link.h"
#include "experiments/sweep/task_queue.h"

namespace mezzotint {

namespace {

using namespace std::chrono_literals;
// Short against any task, and long enough to leave the core to the tasks.
constexpr auto pause = 2ms;
constexpr auto between_reports = 100ms;

struct Failure {
  ExitStatus status = ExitStatus::Failed;
  std::string message;
  std::exception_ptr thrown;  // of this process; null where another rank failed
};

Failure failure_of(std::exception_ptr thrown) {
  try {
    std::rethrow_exception(thrown);
  } catch (const Error& error) {
    return {error.status(), error.what(), thrown};
  } catch (const std::bad_alloc&) {
    return {ExitStatus::Failed, "out of memory", thrown};
  } catch (const std::exception& error) {
    return {ExitStatus::Failed, error.what(), thrown};
  } catch (...) {
    return {ExitStatus::Failed, "an unknown exception", thrown};
  }
}

}  // namespace

/// One sweep, seen from one rank.
class Sweep {
public:
  Sweep(Ranks& ranks, std::size_t count, const SweepTask& task) : link_(*ranks.link_), count_(count), queue_(task) {}

  // Rank 0: deals tasks to itself and to the others.
  std::vector<std::string> lead(const std::function<void(std::size_t done)>& report) {
    results_.resize(count_);
    for (int other = 1; other < link_.count; ++other) away_.insert(other);
    auto next_report = std::chrono::steady_clock::now();
    while (!is_over()) {
      feed_own_threads();
      collect_own_results();
      for (const int other : std::set<int>(away_)) answer(other);
      if (!failure_ && std::chrono::steady_clock::now() >= next_report) {
        next_report += between_reports;
        try {
          report(done_);
        } catch (...) {
          fail(failure_of(std::current_exception()));
        }
      }
      std::this_thread::sleep_for(pause);
    }
    queue_.close();
    queue_.join();
    if (failure_ && failure_->thrown) std::rethrow_exception(failure_->thrown);
    if (failure_) throw Error(failure_->message, failure_->status);
    report(done_);
    return std::move(results_);
  }

  // Another rank: does what it is dealt.
  void follow() {
    bool asked = false, more = true;
    std::optional<ExitStatus> stopped;
    bool told_failure = false;
    while (!stopped && (more || queue_.outstanding() > 0 || told_failure)) {
      send_results();
      if (queue_.failure() && !told_failure) {
        const Failure failure = failure_of(queue_.failure());
        link_.send(0, Note::Failed, numbered(static_cast<std::uint64_t>(failure.status), failure.message));
        told_failure = true;
        queue_.drop();
      }
      if (more && !asked && !told_failure && queue_.outstanding() < queue_.threads()) {
        link_.send(0, Note::Want, numbered(queue_.threads() - queue_.outstanding()));
        asked = true;
      }
      if (const std::optional<Letter> letter = link_.receive(0)) {
        if (letter->note == Note::Stop) stopped = static_cast<ExitStatus>(number_of(letter->bytes));
        if (letter->note == Note::Tasks) {
          asked = false;
          more = add_tasks(letter->bytes);
        }
      }
      std::this_thread::sleep_for(pause);
    }
    if (stopped) queue_.drop();
    queue_.close();
    queue_.join();
    link_.send(0, Note::Finished, {});
    if (stopped) throw StoppedByOtherRank(*stopped);
  }

private:
  [[nodiscard]] bool is_over() const {
    const bool own_done = queue_.outstanding() == 0;
    return away_.empty() && own_done && (failure_ || done_ == count_);
  }

  void feed_own_threads() {
    while (!failure_ && next_ < count_ && queue_.outstanding() < queue_.threads()) queue_.add(next_++);
  }

  void collect_own_results() {
    for (auto& [index, bytes] : queue_.take_results()) keep(index, std::move(bytes));
    if (!failure_ && queue_.failure()) fail(failure_of(queue_.failure()));
  }

  void keep(std::size_t index, std::string bytes) {
    results_.at(index) = std::move(bytes);
    ++done_;
  }

  void fail(Failure failure) {
    if (failure_) return;
    failure_ = std::move(failure);
    queue_.drop();
    for (const int other : away_) link_.send(other, Note::Stop, numbered(static_cast<std::uint64_t>(failure_->status)));
  }

  void answer(int other) {
    while (away_.contains(other)) {
      const std::optional<Letter> letter = link_.receive(other);
      if (!letter) return;
      switch (letter->note) {
        case Note::Want:
          deal(other, number_of(letter->bytes));
          break;
        case Note::Result:
          keep(number_of(letter->bytes), std::string(rest_of(letter->bytes)));
          break;
        case Note::Failed:
        case Note::Gone:
          hear_failure(other, *letter);
          break;
        case Note::Finished:
          away_.erase(other);
          break;
        case Note::Tasks:
        case Note::Stop:
          break;  // rank 0's own
      }
    }
  }

  // Nothing more is dealt after a failure: Stop is under way.
  void deal(int other, std::uint64_t wanted) {
    if (failure_) return;
    std::string indices;
    for (; wanted > 0 && next_ < count_; --wanted) indices += numbered(next_++);
    link_.send(other, Note::Tasks, indices);
  }

  void hear_failure(int other, const Letter& letter) {
    if (letter.note == Note::Gone) away_.erase(other);
    fail({static_cast<ExitStatus>(number_of(letter.bytes)),
          fmt::format("rank {} of {}: {}", other, link_.count, rest_of(letter.bytes)), nullptr});
  }

  bool add_tasks(std::string_view indices) {
    const bool any = !indices.empty();
    for (; !indices.empty(); indices = rest_of(indices)) queue_.add(number_of(indices));
    return any;
  }

  void send_results() {
    for (auto& [index, bytes] : queue_.take_results()) link_.send(0, Note::Result, numbered(index, bytes));
  }

  const Ranks::Link& link_;
  std::size_t count_, next_ = 0, done_ = 0;
  TaskQueue queue_;
  std::vector<std::string> results_;
  std::set<int> away_;  // ranks that have not left the sweep
  std::optional<Failure> failure_;
};

std::vector<std::string> sweep(Ranks& ranks, std::size_t count, const SweepTask& task, const Progress& progress,
                               const std::string& stage, const std::function<std::string(std::size_t)>& name) {
  Sweep one(ranks, count, task);
  if (!ranks.is_first()) {
    one.follow();
    return {};
  }
  return one.lead([&](std::size_t done) {
    const double fraction = count == 0 ? 1.0 : static_cast<double>(done) / static_cast<double>(count);
    report(progress, stage, fraction, name && done < count ? name(done) : std::string());
  });
}

}  // namespace mezzotint
