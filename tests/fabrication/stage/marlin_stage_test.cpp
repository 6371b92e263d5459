#include "fabrication/stage/marlin_stage.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "tests/fabrication/stage/emulated_board.h"

namespace mezzotint {
namespace {

using namespace std::chrono_literals;
using test::BoardFaults;
using test::EmulatedBoard;

MarlinSettings settings(const EmulatedBoard& board) {
  MarlinSettings result;
  result.port = board.port();
  result.boot = 1000ms;
  result.answer = 150ms;
  result.homing = 1000ms;
  return result;
}

// What goes wrong, as the stage says it; nothing where nothing does.
template <typename Act>
std::optional<StageFault> fault_of(const Act& act) {
  try {
    act();
  } catch (const StageError& error) {
    EXPECT_NE(std::string(error.what()).find("stage"), std::string::npos) << error.what();
    return error.fault();
  }
  return {};
}

struct Homed {
  EmulatedBoard board;
  MarlinStage stage{settings(board)};
  Homed() { stage.home(); }
};

TEST(MarlinStage, GoesToEveryLayerExactly) {
  Homed machine;
  EXPECT_EQ(machine.stage.height_um(), 150000);
  for (int layer = 1; layer <= 100; ++layer) {
    machine.stage.move_to(18 * layer, 500.0);
    EXPECT_EQ(machine.board.height_um(), 18 * layer);
  }
  const auto commands = machine.board.commands();
  EXPECT_EQ(commands[0], "G21");
  EXPECT_EQ(commands[1], "G90");
  EXPECT_EQ(commands[2], "G28 Z");
  EXPECT_EQ(std::count(commands.begin(), commands.end(), "G1 Z1.800 F30.0"), 1);
}

TEST(MarlinStage, SendsDamagedLinesAgain) {
  Homed machine;
  for (int layer = 1; layer <= 20; ++layer) {
    machine.board.set({.damaged_lines = layer % 4});
    machine.stage.move_to(18 * layer, 500.0);
    EXPECT_EQ(machine.board.height_um(), 18 * layer);
  }
}

TEST(MarlinStage, GivesUpOnALineThatNeverArrives) {
  Homed machine;
  machine.board.set({.damaged_lines = 1000});
  EXPECT_EQ(fault_of([&] { machine.stage.move_to(18, 500.0); }), StageFault::Garbled);
  machine.board.set({});
  machine.stage.move_to(36, 500.0);
  EXPECT_EQ(machine.board.height_um(), 36);
}

TEST(MarlinStage, OutlivesALostAcknowledgement) {
  Homed machine;
  for (int layer = 1; layer <= 5; ++layer) {
    machine.board.set({.lost_answers = 1});
    machine.stage.move_to(18 * layer, 50000.0);
    EXPECT_EQ(machine.board.height_um(), 18 * layer);
  }
  const auto commands = machine.board.commands();
  EXPECT_EQ(std::count_if(commands.begin(), commands.end(), [](const auto& c) { return c.starts_with("G1"); }), 5)
      << "a line that had come is not carried out twice";
}

TEST(MarlinStage, WaitsForABoardThatIsBusy) {
  Homed machine;
  machine.board.set({.busy = 8, .busy_ms = 50});
  machine.stage.move_to(18, 100000.0);
  EXPECT_EQ(machine.board.height_um(), 18);
}

TEST(MarlinStage, SaysThatABoardIsSilent) {
  Homed machine;
  machine.board.set({.silent = true});
  EXPECT_EQ(fault_of([&] { machine.stage.move_to(18, 100000.0); }), StageFault::Silent);
  EmulatedBoard mute({.silent = true});
  EXPECT_EQ(fault_of([&] { MarlinStage stage(settings(mute)); }), StageFault::Silent);
}

TEST(MarlinStage, SaysThatABoardIsBusyForEver) {
  Homed machine;
  machine.board.set({.busy = 40, .busy_ms = 50});
  const auto begin = std::chrono::steady_clock::now();
  EXPECT_EQ(fault_of([&] { machine.stage.move_to(18, 1e6); }), StageFault::Silent);
  EXPECT_LT(std::chrono::steady_clock::now() - begin, 5s);
  machine.board.set({});
}

TEST(MarlinStage, NoticesARestartAndWantsToBeHomed) {
  Homed machine;
  for (int line = 0; line < 3; ++line) {
    machine.stage.move_to(180, 500.0);
    machine.board.set({.reboot_after = line});
    EXPECT_EQ(fault_of([&] { machine.stage.move_to(198, 500.0); }), StageFault::PositionLost) << line;
    EXPECT_FALSE(machine.stage.is_homed());
    EXPECT_EQ(fault_of([&] { machine.stage.move_to(198, 500.0); }), StageFault::PositionLost) << "refused until homed";
    machine.board.set({});
    machine.stage.home();
    EXPECT_TRUE(machine.stage.is_homed());
  }
}

// A restart whose banner got lost shows in the line numbers.
TEST(MarlinStage, NoticesARestartWithoutItsBanner) {
  Homed machine;
  machine.board.set({.reboot_after = 0, .mute_banner = true});
  EXPECT_EQ(fault_of([&] { machine.stage.move_to(18, 500.0); }), StageFault::PositionLost);
  EXPECT_FALSE(machine.stage.is_homed());
}

TEST(MarlinStage, ReadsBackWhereItIs) {
  Homed machine;
  machine.board.set({.drift_um = 20});
  EXPECT_EQ(fault_of([&] { machine.stage.move_to(18, 500.0); }), StageFault::WrongPosition);
  EXPECT_FALSE(machine.stage.is_homed());
}

TEST(MarlinStage, SaysThatTheEndSwitchWasNotFound) {
  EmulatedBoard board;
  MarlinStage stage(settings(board));
  board.set({.no_endstop = true});
  EXPECT_EQ(fault_of([&] { stage.home(); }), StageFault::NoEndstop);
  EXPECT_FALSE(stage.is_homed());
}

TEST(MarlinStage, SaysThatTheBoardRefuses) {
  Homed machine;
  machine.board.set({.refuses = true});
  EXPECT_EQ(fault_of([&] { machine.stage.move_to(18, 500.0); }), StageFault::Refused);
}

TEST(MarlinStage, NoticesAnUnpluggedCable) {
  for (int line = 0; line < 3; ++line) {
    Homed machine;
    machine.board.set({.unplug_after = line});
    EXPECT_EQ(fault_of([&] { machine.stage.move_to(18, 500.0); }), StageFault::Disconnected) << line;
    EXPECT_FALSE(machine.stage.is_homed());
  }
  MarlinSettings nowhere;
  nowhere.port = "/dev/ttyNoSuchPort";
  EXPECT_EQ(fault_of([&] { MarlinStage stage(nowhere); }), StageFault::Disconnected);
}

TEST(MarlinStage, WaitsForABoardThatRestartsAsThePortIsOpened) {
  EmulatedBoard board({.boots_slowly = true});
  MarlinStage stage(settings(board));
  stage.home();
  stage.move_to(18, 500.0);
  EXPECT_EQ(board.height_um(), 18);
}

TEST(MarlinStage, RefusesToMoveUnhomedOrBeyondItsTravel) {
  EmulatedBoard board;
  MarlinStage stage(settings(board));
  EXPECT_EQ(fault_of([&] { stage.move_to(18, 500.0); }), StageFault::PositionLost);
  stage.home();
  EXPECT_THROW(stage.move_to(-1, 500.0), InvalidInput);
  EXPECT_THROW(stage.move_to(200001, 500.0), InvalidInput);
  EXPECT_THROW(stage.move_to(18, 0.0), InvalidInput);
  EXPECT_EQ(board.height_um(), 150000);
}

}  // namespace
}  // namespace mezzotint
