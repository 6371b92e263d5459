#include <sys/wait.h>
#include <cstdlib>
#include <string>

#include <gtest/gtest.h>

#include "tests/loop/workplace.h"

namespace mezzotint::test {
namespace {

// A small gamut: 2 kinds × 3 blurs × 3 rays.
constexpr const char* small_gamut =
    "gamut printer.toml --pattern sinusoid --pattern ridges --rays 3 --quiet --threads 1";

bool mpirun_is_there() { return std::system("mpirun --version > /dev/null 2>&1") == 0; }

// By a shell, since mpirun stands between; two ranks on however few cores there are.
int with_two_ranks(const Workplace& here, const std::string& arguments) {
  const std::string command = "cd '" + here.path().string() +
                              "' && timeout 120 mpirun -n 2 --allow-run-as-root --oversubscribe '" +
                              MEZZOTINT_PROGRAM_PATH + "' " + arguments + " > out.txt 2> err.txt";
  const int status = std::system(command.c_str());
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128;
}

class TwoRanks : public testing::Test {
protected:
  void SetUp() override {
    if (!MEZZOTINT_HAS_MPI) GTEST_SKIP() << "built without MPI (libopenmpi-dev)";
    if (!mpirun_is_there()) GTEST_SKIP() << "mpirun is not installed (openmpi-bin)";
  }
  Workplace here;
};

TEST_F(TwoRanks, GiveTheBytesOfOneProcess) {
  ASSERT_EQ(here.mezzotint(words(std::string(small_gamut) + " -o one")).status, 0);
  ASSERT_EQ(with_two_ranks(here, std::string(small_gamut) + " -o two"), 0) << here.read("err.txt");
  for (const char* file : {"gamut.json", "gamut.csv", "gamut.svg", "gamut.html"})
    EXPECT_EQ(here.read((std::string("one/") + file).c_str()), here.read((std::string("two/") + file).c_str())) << file;
  const std::string out = here.read("out.txt");
  EXPECT_EQ(out.find("wrote"), out.rfind("wrote")) << "both ranks speak";
}

TEST_F(TwoRanks, MakeTheDesignsOfOneProcess) {
  here.write("other.toml", small_experiment("alpha_x   = 0.30", "alpha_x = 0.25"));
  ASSERT_EQ(here.mezzotint(words("design small.toml other.toml -q -o one")).status, 0);
  ASSERT_EQ(with_two_ranks(here, "design small.toml other.toml -q -o two"), 0) << here.read("err.txt");
  for (const char* name : {"small", "other"}) {
    const auto files = [&](const std::string& folder) { return here.files((folder + "/" + name).c_str()); };
    EXPECT_TRUE(files("one").contains("design.json"));
    EXPECT_EQ(differences(files("one"), files("two")), "") << name;
  }
}

TEST_F(TwoRanks, StopTogetherWithOneMessage) {
  here.write("printer.toml", "nmae = \"dlp9000\"\n");
  EXPECT_EQ(with_two_ranks(here, std::string(small_gamut) + " -o two"), 2);
  const std::string err = here.read("err.txt");
  EXPECT_NE(err.find("did you mean \"name\""), std::string::npos) << err;
  EXPECT_EQ(err.find("did you mean"), err.rfind("did you mean")) << err;
}

// Rank 0 alone makes the folder; the other waits in the sweep and must not wait for ever.
TEST_F(TwoRanks, StopWhereTheFirstOneFailsAlone) {
  here.write("file", "no folder");
  EXPECT_EQ(with_two_ranks(here, std::string(small_gamut) + " -o file/two"), 1);
  EXPECT_NE(here.read("err.txt").find("cannot make the folder"), std::string::npos);
}

// A profile that only one machine has.
TEST_F(TwoRanks, StopWhereTheOtherOneFailsAlone) {
  here.write("start.sh", std::string("cd \"$(dirname \"$0\")\"; [ \"$OMPI_COMM_WORLD_RANK\" = 1 ] && cd /; exec '") +
                             MEZZOTINT_PROGRAM_PATH + "' " + small_gamut + " -o '" + (here / "two").string() + "'\n");
  const std::string command = "timeout 120 mpirun -n 2 --allow-run-as-root --oversubscribe sh '" +
                              (here / "start.sh").string() + "' > '" + (here / "out.txt").string() + "' 2> '" +
                              (here / "err.txt").string() + "'";
  const int status = std::system(command.c_str());
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 2);
  EXPECT_NE(here.read("err.txt").find("rank 1 of 2: printer.toml"), std::string::npos) << here.read("err.txt");
  EXPECT_FALSE(std::filesystem::exists(here / "two/gamut.json"));
}

TEST_F(TwoRanks, RefuseACommandThatDoesNotSpread) {
  EXPECT_EQ(with_two_ranks(here, "run small.toml --quiet"), 2);
  EXPECT_NE(here.read("err.txt").find("does not spread over ranks"), std::string::npos);
}

}  // namespace
}  // namespace mezzotint::test
