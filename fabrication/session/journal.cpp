#include "fabrication/session/journal.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>
#include <span>
#include <sstream>

#include <fmt/format.h>

#include "forward/base/digest.h"
#include "forward/base/error.h"

namespace mezzotint {

namespace {

constexpr std::size_t largest_journal = std::size_t{1} << 26;
constexpr std::size_t check_digits = 8;

std::string check_of(std::string_view text) {
  return sha256_hex(std::as_bytes(std::span(text.data(), text.size()))).substr(0, check_digits);
}

[[noreturn]] void cannot_write(const std::filesystem::path& path) {
  throw DeviceError("cannot write the print's journal " + path.string() + ": " + std::strerror(errno) +
                    "; without it nothing is exposed");
}

// The light that a layer got before is kept while more is added to it.
OpenLayer with_exposure_begun(const OpenLayer& before, double exposure_s) {
  return {before.index, before.least_s, before.most_s + exposure_s, before.taken_s, false};
}

OpenLayer with_exposure_cut(const OpenLayer& before, double least_s, double most_s, bool certain) {
  return {before.index, before.least_s + least_s, before.most_s + most_s, before.taken_s + 0.5 * (least_s + most_s),
          certain};
}

void apply_done(JournalState& state, double lit_s) {
  state.lit_s.push_back(lit_s);
  ++state.done;
  state.open.reset();
}

void apply_decided(std::istringstream& line, JournalState& state) {
  std::string word;
  line >> word;
  if (!state.open) {
    line.setstate(std::ios::failbit);
    return;
  }
  state.decided.push_back(state.done);
  if (word == "repeat") {
    state.open.reset();
  } else if (word == "skip") {
    apply_done(state, state.open->least_s);
  } else if (word == "complete") {
    state.open->taken_s = state.open->least_s;
    state.open->certain = true;
  } else {
    line.setstate(std::ios::failbit);
  }
}

/// Reads line after line, and remembers what an exposure added to what was there.
class JournalText {
public:
  explicit JournalText(const std::filesystem::path& path) : path_(path) {}

  void take(const std::string& text, std::size_t number) {
    std::istringstream line(text);
    std::string word;
    line >> word;
    if (number == 1) {
      int version = 0;
      line >> version >> state.job >> state.plan >> state.layers;
      if (word != "mezzotint-print" || version != 1) refuse(number, "is no journal of a print of version 1");
    } else {
      event(line, word, number);
    }
    if (!line) refuse(number, "cannot be understood");
  }

  [[noreturn]] void refuse(std::size_t number, const std::string& problem) const {
    throw FileError(path_, fmt::format("line {}", number), problem + "; a print cannot go on from it");
  }

  JournalState state;

private:
  void event(std::istringstream& line, const std::string& word, std::size_t number) {
    if (word == "finished") {
      state.finished = true;
      return;
    }
    std::size_t layer = 0;
    line >> layer;
    if (layer != state.done || layer >= state.layers) refuse(number, "speaks of a layer out of turn");
    if (word == "exposing") {
      double exposure_s = 0.0;
      line >> exposure_s;
      before_ = state.open.value_or(OpenLayer{layer});
      state.open = with_exposure_begun(before_, exposure_s);
    } else if (word == "cut") {
      double least_s = 0.0, most_s = 0.0;
      std::string known;
      line >> least_s >> most_s >> known;
      if (!state.open || (known != "certain" && known != "uncertain")) refuse(number, "cannot be understood");
      state.open = with_exposure_cut(before_, least_s, most_s, known == "certain");
    } else if (word == "done") {
      double lit_s = 0.0;
      line >> lit_s;
      apply_done(state, lit_s);
    } else if (word == "decided") {
      apply_decided(line, state);
    } else {
      refuse(number, "has an unknown word \"" + word + "\"");
    }
  }

  std::filesystem::path path_;
  OpenLayer before_;
};

struct ReadJournal {
  JournalState state;
  std::size_t whole_bytes = 0;  ///< what follows is torn
};

ReadJournal parse(const std::string& bytes, const std::filesystem::path& path) {
  JournalText text(path);
  std::size_t begin = 0, number = 0;
  while (begin < bytes.size()) {
    const auto end = bytes.find('\n', begin);
    ++number;
    const std::string line = bytes.substr(begin, end == std::string::npos ? end : end - begin);
    const bool sound = line.size() > check_digits + 1 && line[line.size() - check_digits - 1] == ' ' &&
                       check_of(std::string_view(line).substr(0, line.size() - check_digits - 1)) ==
                           line.substr(line.size() - check_digits);
    // A crash leaves a line without its end; a whole line that is wrong was damaged later.
    if (end == std::string::npos) break;
    if (!sound) text.refuse(number, "is damaged");
    text.take(line.substr(0, line.size() - check_digits - 1), number);
    begin = end + 1;
  }
  return {text.state, begin};
}

std::string bytes_of(const std::filesystem::path& path) {
  std::error_code problem;
  const auto size = std::filesystem::file_size(path, problem);
  if (problem) throw FileError(path, "", "cannot be read: " + problem.message());
  if (size > largest_journal) throw FileError(path, "", "is too large for a journal of a print");
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

Descriptor open_locked(const std::filesystem::path& path, int flags) {
  Descriptor file(::open(path.c_str(), flags | O_CLOEXEC, 0644));
  if (file.number() < 0) cannot_write(path);
  if (::flock(file.number(), LOCK_EX | LOCK_NB) != 0) {
    throw DeviceError(path.string() + ": another process prints with this journal");
  }
  return file;
}

// A new file is there after a power cut only when its folder is on disk too.
void sync_folder(const std::filesystem::path& path) {
  const auto folder = path.parent_path().empty() ? std::filesystem::path(".") : path.parent_path();
  const Descriptor descriptor(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (descriptor.number() < 0 || ::fsync(descriptor.number()) != 0) cannot_write(path);
}

}  // namespace

Journal::Journal(Descriptor file, std::filesystem::path path, JournalState state)
    : file_(std::move(file)), path_(std::move(path)), state_(std::move(state)) {}

Journal Journal::begin(const std::filesystem::path& path, const std::string& job, const std::string& plan,
                       std::size_t layers) {
  Descriptor file = open_locked(path, O_RDWR | O_CREAT | O_APPEND);
  const ReadJournal old = parse(bytes_of(path), path);
  require(
      old.whole_bytes == 0 || old.state.finished,
      fmt::format("{} is of a print that ended before layer {} of {}; go on with --resume, or delete it to begin anew",
                  path.string(), old.state.done + 1, old.state.layers));
  if (::ftruncate(file.number(), 0) != 0) cannot_write(path);
  JournalState state;
  state.job = job;
  state.plan = plan;
  state.layers = layers;
  Journal journal(std::move(file), path, std::move(state));
  journal.append(fmt::format("mezzotint-print 1 {} {} {}", job, plan, layers));
  sync_folder(path);
  return journal;
}

Journal Journal::resume(const std::filesystem::path& path, const std::string& job, const std::string& plan) {
  require(std::filesystem::exists(path), path.string() + ": there is no such journal; print without --resume");
  Descriptor file = open_locked(path, O_RDWR | O_APPEND);
  ReadJournal old = parse(bytes_of(path), path);
  require(old.whole_bytes > 0, path.string() + " is empty; nothing was printed. Delete it and print without --resume");
  require(old.state.job == job, path.string() + " is of another job, or this one was changed since");
  require(old.state.plan == plan,
          path.string() + ": heights, exposures, LED amplitude or flips were changed since (job or machine profile)");
  require(!old.state.finished, path.string() + ": this print is finished; print without --resume to print it again");
  if (::ftruncate(file.number(), static_cast<off_t>(old.whole_bytes)) != 0) cannot_write(path);
  return {std::move(file), path, std::move(old.state)};
}

void Journal::append(const std::string& text) {
  const std::string line = text + " " + check_of(text) + "\n";
  const off_t before = ::lseek(file_.number(), 0, SEEK_END);
  std::size_t written = 0;
  while (written < line.size()) {
    const auto count = ::write(file_.number(), line.data() + written, line.size() - written);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) {
      const int problem = errno;
      // Half a line in the middle would spoil the journal for what is still to be said.
      [[maybe_unused]] const int undone = ::ftruncate(file_.number(), before);
      errno = problem;
      cannot_write(path_);
    }
    written += static_cast<std::size_t>(count);
  }
  if (::fdatasync(file_.number()) != 0) cannot_write(path_);
}

void Journal::exposing(std::size_t layer, double exposure_s) {
  append(fmt::format("exposing {} {:.9g}", layer, exposure_s));
  before_ = state_.open.value_or(OpenLayer{layer});
  state_.open = with_exposure_begun(before_, exposure_s);
}

void Journal::cut(std::size_t layer, double least_s, double most_s, bool certain) {
  append(fmt::format("cut {} {:.9g} {:.9g} {}", layer, least_s, most_s, certain ? "certain" : "uncertain"));
  state_.open = with_exposure_cut(before_, least_s, most_s, certain);
}

void Journal::done(std::size_t layer, double lit_s) {
  append(fmt::format("done {} {:.9g}", layer, lit_s));
  apply_done(state_, lit_s);
}

void Journal::decide(std::size_t layer, const std::string& word) {
  append(fmt::format("decided {} {}", layer, word));
  std::istringstream line(word);
  apply_decided(line, state_);
}

void Journal::finished() {
  append("finished");
  state_.finished = true;
}

JournalState read_journal(const std::filesystem::path& path) { return parse(bytes_of(path), path).state; }

}  // namespace mezzotint
