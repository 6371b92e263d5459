#include "experiments/configuration/machine_file.h"

#include <fstream>

#include <gtest/gtest.h>

#include "experiments/configuration/toml_table.h"
#include "tests/test_data.h"

namespace mezzotint {
namespace {

struct MachineFile : ::testing::Test {
  test::TemporaryFolder folder;
  Machine read(const std::string& text) {
    std::ofstream(folder / "machine.toml") << text;
    return read_machine(folder / "machine.toml");
  }
};

TEST_F(MachineFile, OfNothingHasTheDefaults) {
  const Machine machine = read("");
  EXPECT_EQ(machine.profile.name, "machine");
  EXPECT_EQ(machine.profile.bottom_layers, MachineProfile{}.bottom_layers);
  EXPECT_EQ(machine.profile.slow_lift_um, MachineProfile{}.slow_lift_um);
  EXPECT_EQ(machine.projector.way, Dlpc900Options::Way::Video);
}

TEST_F(MachineFile, TheExampleIsRead) {
  const Machine machine =
      read_machine(std::filesystem::path(MEZZOTINT_SOURCE_DIR) / "experiments" / "machines" / "dlp9000.toml");
  EXPECT_EQ(machine.profile.name, "dlp9000");
  EXPECT_TRUE(machine.profile.flip_columns);
  EXPECT_EQ(machine.profile.bottom_layers, 3U);
  EXPECT_EQ(machine.profile.transition_layers, 3U);
}

TEST_F(MachineFile, KeysReachTheirPlaces) {
  const Machine machine = read(
      "[projector]\nway = \"upload\"\nvideo_cable = \"hdmi\"\nleds = 4\nusb = \"001:004\"\n"
      "[stage]\nhome = \"bottom\"\nport = \"/dev/ttyACM1\"\nzero_um = -120\n[lift]\nslow_um = "
      "700\n[wait]\nafter_lift_s = 2\n");
  EXPECT_EQ(machine.projector.way, Dlpc900Options::Way::Upload);
  EXPECT_EQ(machine.projector.video_receiver, 1);
  EXPECT_EQ(machine.projector.leds, 4U);
  EXPECT_EQ(machine.usb, "001:004");
  EXPECT_EQ(machine.profile.home_at, HomeAt::Bottom);
  EXPECT_EQ(machine.profile.port, "/dev/ttyACM1");
  EXPECT_EQ(machine.profile.zero_um, -120);
  EXPECT_EQ(machine.profile.slow_lift_um, 700);
  EXPECT_EQ(machine.profile.after_lift_s, 2.0);
}

TEST_F(MachineFile, WhatMakesNoSenseIsRefused) {
  for (const char* text : {"speed = 1", "[stage]\nspeed = 1", "[lift]\nslow_mm = 1", "[stage]\ndialect = \"grbl\"",
                           "[stage]\nzero_um = 0.5", "[projector]\nled_amplitude = 256",
                           "[bottom]\ntransition_layers = 2", "[lift]\nslow_um = 0\nfast_um = 0",
                           "[stage]\nzero_um = 5000\nhighest_um = 4000", "[wait]\nbefore_exposure_s = -1"}) {
    EXPECT_THROW(read(text), ConfigurationError) << text;
  }
}

}  // namespace
}  // namespace mezzotint
