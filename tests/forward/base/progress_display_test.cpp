#include "forward/base/progress_display.h"

#include <memory>
#include <sstream>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace mezzotint {
namespace {

// What a display writes, on a stream that is no terminal.
std::string shown(ProgressStyle style, const std::vector<ProgressEvent>& events) {
  char* text = nullptr;
  std::size_t size = 0;
  std::FILE* stream = ::open_memstream(&text, &size);
  {
    ProgressDisplay display(style, stream);
    for (const auto& event : events) display.show(event);
  }
  std::fclose(stream);
  const std::unique_ptr<char, decltype(&std::free)> owner(text, &std::free);
  return {text, size};
}

const std::vector<ProgressEvent> two_stages = {{"search", 0.0, ""},
                                               {"search", 0.5, "half"},
                                               {"search", 1.0, "80 evaluations"},
                                               {"print", 0.0, ""},
                                               {"print", 1.0, ""}};

TEST(ProgressDisplay, WritesALineWhenAStageBeginsAndEnds) {
  const std::string text = shown(ProgressStyle::Lines, two_stages);
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 4);
  EXPECT_NE(text.find("search: 100 %"), std::string::npos);
  EXPECT_NE(text.find("80 evaluations"), std::string::npos);
  EXPECT_EQ(text.find('\r'), std::string::npos);
}

TEST(ProgressDisplay, WritesOneJsonObjectALineForPrograms) {
  std::istringstream lines(shown(ProgressStyle::Events, two_stages));
  int count = 0;
  for (std::string line; std::getline(lines, line); ++count) {
    const auto event = nlohmann::json::parse(line);
    EXPECT_EQ(event.at("event"), "progress");
    EXPECT_TRUE(event.at("fraction").is_number());
  }
  EXPECT_GE(count, 4);
}

TEST(ProgressDisplay, EndsTheLineOfItsBar) {
  const std::string text = shown(ProgressStyle::Bar, {{"search", 0.3, ""}});
  EXPECT_EQ(text.back(), '\n');
  EXPECT_NE(text.find("30 %"), std::string::npos);
}

TEST(ProgressDisplay, SaysNothingWhenQuiet) { EXPECT_EQ(shown(ProgressStyle::Quiet, two_stages), ""); }

TEST(ProgressDisplay, DrawsNoBarWhereNoTerminalIs) {
  std::FILE* stream = std::tmpfile();
  EXPECT_EQ(natural_style(stream), ProgressStyle::Lines);
  std::fclose(stream);
}

}  // namespace
}  // namespace mezzotint
