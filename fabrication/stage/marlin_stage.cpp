#include "fabrication/stage/marlin_stage.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "fabrication/stage/marlin_words.h"

namespace mezzotint {

namespace {

using std::chrono::milliseconds;
using std::chrono::steady_clock;

constexpr int largest_repeats = 5;

}  // namespace

MarlinStage::MarlinStage(MarlinSettings settings)
    : settings_(std::move(settings)), line_(settings_.port, settings_.baud) {
  greet();
  command("G21", settings_.answer);
  command("G90", settings_.answer);
}

void MarlinStage::fail(StageFault fault, std::string_view text, const std::string& problem) {
  homed_ = homed_ && fault != StageFault::PositionLost && fault != StageFault::WrongPosition &&
           fault != StageFault::NoEndstop && fault != StageFault::Disconnected;
  throw StageError(fault, fmt::format("{}: the stage, asked for \"{}\", {}", settings_.port, text, problem));
}

// A board that restarts as the port is opened misses what is sent meanwhile: the greeting is repeated after its banner.
void MarlinStage::greet() {
  const auto deadline = steady_clock::now() + settings_.boot;
  const std::string greeting = numbered_line(0, "M110 N0");
  auto again = steady_clock::now();
  while (steady_clock::now() < deadline) {
    if (steady_clock::now() >= again) {
      line_.write(greeting);
      again = steady_clock::now() + settings_.boot / 4;
    }
    const auto line = line_.read_line(std::min(deadline, again));
    if (!line) continue;
    const auto kind = parse_marlin_reply(*line).kind;
    if (kind == MarlinReply::Kind::Restarted) {
      homed_ = false;
      again = steady_clock::now();
    }
    if (kind == MarlinReply::Kind::Acknowledged) {
      // Answers to repeated greetings must not be taken for those of the next lines.
      while (line_.read_line(steady_clock::now() + milliseconds(50))) {
      }
      number_ = 0;
      greeted_ = true;
      return;
    }
  }
  fail(StageFault::Silent, "M110 N0", "does not answer; are the port and the baud rate right, and is it powered?");
}

MarlinStage::Answer MarlinStage::await(std::string_view text, std::int64_t number, Time deadline) {
  bool again = false;
  auto patience = std::min(deadline, steady_clock::now() + settings_.answer);
  if (text == "M400" || text.starts_with("G28")) patience = deadline;
  for (;;) {
    const auto line = line_.read_line(patience);
    if (!line) return Answer::Silence;
    const MarlinReply reply = parse_marlin_reply(*line);
    switch (reply.kind) {
      case MarlinReply::Kind::Acknowledged:
        return again ? Answer::Again : Answer::Taken;
      case MarlinReply::Kind::Resend:
        if (reply.number < number) {
          fail(StageFault::PositionLost, text,
               "counts lines anew: it restarted, and its position is lost; home it again");
        }
        // One beyond ours: ours had come, only its acknowledgement was lost.
        again = reply.number == number;
        break;
      case MarlinReply::Kind::Busy:
        patience = std::max(patience, std::min(deadline, steady_clock::now() + settings_.answer));
        break;
      case MarlinReply::Kind::HomingFailed:
        fail(StageFault::NoEndstop, text, "did not find its end switch");
      case MarlinReply::Kind::Refused:
        fail(StageFault::Refused, text, "said \"" + *line + "\"");
      case MarlinReply::Kind::Restarted:
        fail(StageFault::PositionLost, text, "restarted: its position is lost; home it again");
      case MarlinReply::Kind::Position:
        reported_um_ = reply.height_um;
        reported_ = true;
        break;
      case MarlinReply::Kind::LineDamaged:
      case MarlinReply::Kind::Remark:
        break;
    }
  }
}

void MarlinStage::command(std::string_view text, milliseconds limit) {
  if (!greeted_) {
    greet();
    command("G21", settings_.answer);
    command("G90", settings_.answer);
  }
  const std::int64_t number = ++number_;
  const std::string bytes = numbered_line(number, text);
  const auto deadline = steady_clock::now() + limit;
  int silences = 0;
  try {
    for (int repeat = 0; repeat <= largest_repeats; ++repeat) {
      line_.write(bytes);
      const Answer answer = await(text, number, deadline);
      if (answer == Answer::Taken) return;
      if (answer == Answer::Again) continue;
      if (steady_clock::now() >= deadline) fail(StageFault::Silent, text, "did not get done in time");
      if (++silences == 2) fail(StageFault::Silent, text, "does not answer");
    }
  } catch (const StageError& error) {
    // From here on nobody knows which line the board expects.
    greeted_ = false;
    if (error.fault() == StageFault::PositionLost || error.fault() == StageFault::Disconnected) homed_ = false;
    throw;
  }
  greeted_ = false;
  fail(StageFault::Garbled, text,
       fmt::format("wanted the line again {} times; check cable and baud rate", largest_repeats));
}

std::int64_t MarlinStage::height_um() {
  reported_ = false;
  command("M114", settings_.answer * 2);
  if (!reported_) fail(StageFault::Refused, "M114", "did not say where it is");
  return reported_um_;
}

void MarlinStage::home() {
  homed_ = false;
  command("G28 Z", settings_.homing);
  command("M400", settings_.homing);
  const std::int64_t height = height_um();
  if (height < settings_.lowest_um - settings_.tolerance_um || height > settings_.highest_um + settings_.tolerance_um) {
    fail(StageFault::WrongPosition, "G28 Z",
         fmt::format("is at {} mm after homing, outside of its travel", millimetres(height)));
  }
  homed_ = true;
}

void MarlinStage::move_to(std::int64_t height_um_wanted, double speed_um_per_s) {
  const std::string height = millimetres(height_um_wanted);
  require(height_um_wanted >= settings_.lowest_um && height_um_wanted <= settings_.highest_um,
          fmt::format("the stage goes from {} to {} mm, not to {} mm", millimetres(settings_.lowest_um),
                      millimetres(settings_.highest_um), height));
  require(speed_um_per_s >= 1.0 && speed_um_per_s <= 1e6, "a stage's speed lies between 1 and 1000000 µm/s");
  if (!homed_) {
    throw StageError(StageFault::PositionLost, settings_.port + ": the stage's height is not known; home it first");
  }
  const double longest_s = double(settings_.highest_um - settings_.lowest_um) / speed_um_per_s;
  const auto limit = settings_.answer + milliseconds(std::llround(1500.0 * longest_s));
  command(fmt::format("G1 Z{} F{:.1f}", height, speed_um_per_s * 0.06), limit);
  command("M400", limit);
  const std::int64_t reached = height_um();
  if (std::abs(reached - height_um_wanted) > settings_.tolerance_um) {
    fail(StageFault::WrongPosition, "G1 Z" + height,
         fmt::format("is at {} mm (tolerance {} µm); home it again", millimetres(reached), settings_.tolerance_um));
  }
}

}  // namespace mezzotint
