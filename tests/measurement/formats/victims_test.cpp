// No tests: the victims of the others here (the name lets CMake find it).
#include "tests/measurement/formats/victims.h"

#include <limits>

#include "tests/measurement/formats/instrument_builders.h"

namespace mezzotint::test {

namespace {

std::string small_opd() {
  OpdRecipe recipe;
  recipe.columns = 3;
  recipe.rows = 2;
  for (const int value : {1, 2, 32767, 4, 5, 6}) append(recipe.samples, static_cast<std::int16_t>(value));
  return build_opd(recipe);
}

SurRecipe small_sur(int streams, std::int16_t bits) {
  SurRecipe recipe;
  recipe.columns = 3;
  recipe.rows = 2;
  recipe.counts = {-1002, 4, 60, 80, 100, 120};
  recipe.lowest = -1000;
  recipe.marked = true;
  recipe.streams = streams;
  recipe.bits = bits;
  recipe.comment = "a comment";
  return recipe;
}

std::string binary_sdf(const std::string& version) {
  std::string data;
  for (const int value : {1, 2, -32768, 4, 32767, 6}) append(data, static_cast<std::int16_t>(value));
  return build_sdf_header({version, 3, 2, 5}) + data;
}

std::string sidecar_of_all_keys() {
  return "width_um = 640.0\nlength_um = 3.2e2\ndepth_um = 18\nvalue_um = 1.0\nxy_um = 1.0\ndatum_um = -2.5\n"
         "missing_gray = 0\nperiodic = true\nfirst_row = \"bottom\"\ntitle = \"coin \\u00b5\"\n"
         "[provenance]\noperator = 'me'\n\"two words\" = \"\"\"\nlines\"\"\"\n";
}

std::vector<Victim> pictures() {
  const std::vector<unsigned> grays = {0, 1, 32767, 32768, 65534, 65535};
  const std::vector<double> values(grays.begin(), grays.end());
  std::string floats = build_exr(3, 2, {1.0F, -2.0F, 3.0F, std::numeric_limits<float>::infinity(), 5.0F, 6.0F});
  return {{"png", "png, 16 bits", fuzzed::png, build_png(3, 2, 16, grays)},
          {"png", "png, 8 bits", fuzzed::png, build_png(3, 2, 8, {0, 1, 127, 128, 254, 255})},
          // libtiff reads a directory whose last 4 bytes, the place of a next one, are missing.
          {"tiff", "tiff, II", fuzzed::tiff, build_tiff({3, 2, 16, false, false, values}), 4},
          {"tiff", "tiff, MM", fuzzed::tiff, build_tiff({3, 2, 16, true, false, values}), 4},
          {"tiff", "tiff, floats", fuzzed::tiff, build_tiff({3, 2, 32, false, true, values}), 4},
          {"exr", "exr", fuzzed::exr, floats},
          {"quality_map", "bmp", fuzzed::quality_map, build_bmp(3, 2, {1, 2, 3, 4, 5, 6})}};
}

std::vector<Victim> texts() {
  return {{"csv", "csv, commas", fuzzed::csv, "# relief\n1.5,,-3e2\n4,NaN,6\n", 0, true},
          {"csv", "csv, blanks", fuzzed::csv, "1.5 2 -3e2\r\n 4  BAD 6\r\n", 0, true},
          {"xyz", "xyz", fuzzed::xyz, "0 0 1.5\n1 0 2\n2 0 -3\n0 1 4\n1 1 nan\n2 1 6\n", 0, true},
          {"xyz", "xyz, semicolons", fuzzed::xyz, "0.5;0;1\n1.0;0;2\n0.5;2;3\n", 0, true},
          {"sidecar", "sidecar", fuzzed::sidecar, sidecar_of_all_keys(), 0, true},
          {"x3p_document", "main.xml, binary", fuzzed::x3p_document, binary_xml()},
          {"x3p_document", "main.xml, listed", fuzzed::x3p_document, listed_xml()},
          // Behind the star that ends the data.
          {"sdf", "sdf, text", fuzzed::sdf, build_text_sdf("aISO-1.0", 3, 2, 7, "1 2.5 BAD\r\n4 5e0 6"), 10},
          {"sdf", "sdf, old text", fuzzed::sdf, build_text_sdf("aBCR-1.0", 3, 2, 5, "1 2 32767 4 5 6"), 10}};
}

}  // namespace

std::string small_al3d() {
  std::vector<float> heights_m;
  for (int i = 0; i < 15; ++i) heights_m.push_back(0.0763F + 1e-6F * static_cast<float>(i));
  heights_m[4] = 3.000000028082e+15F;
  return build_al3d({5, 3, heights_m, true, true, {}});
}

std::string small_gwy() {
  GwyBuilder container;
  container.object("/0/data", "GwyDataField", gwy_field(3, 2, 6e-6, 8e-6, {1e-6, 2e-6, 3e-6, 7e-6, 8e-6, 9e-6}));
  container.object("/0/mask", "GwyDataField", gwy_field(3, 2, 1.0, 1.0, {0, 0, 0, 1, 0, 0}));
  container.text("/0/data/title", "relief").texts("/names", {"one", "two"});
  container.objects("/selections", "GwySelectionPoint", {GwyBuilder().real("x", 1.0), GwyBuilder()});
  container.object("/0/meta", "GwyContainer", GwyBuilder().text("Mezzotint continuation", "periodic, 3 x 2 samples"));
  return container.file();
}

std::string binary_xml() {
  return build_main_xml({3, 2, "<AxisType>I</AxisType><DataType>I</DataType><Increment>1e-6</Increment>",
                         data_link("", true), "SUR", ""});
}

std::string listed_xml() {
  return build_main_xml({2, 2, "<AxisType>A</AxisType><DataType>D</DataType>",
                         "<DataList><Datum>1e-6</Datum><Datum/><Datum>2</Datum><Datum>3</Datum></DataList>", "SUR",
                         ""});
}

std::string x3p_of(const std::string& xml, std::uint16_t method) {
  return build_zip({{"main.xml", xml, method},
                    {"bindata/data.bin", std::string("\1\0\2\0\3\0\4\0\5\0\6\0", 12), method},
                    {"bindata/valid.bin", "\x3D", method}});
}

std::vector<Victim> victims() {
  std::vector<Victim> all = {
      // The texture of 5 columns padded to 8, in 3 rows.
      {"al3d", "al3d", fuzzed::al3d, small_al3d(), 24},
      {"gwy", "gwy", fuzzed::gwy, small_gwy()},
      {"x3p", "x3p, stored", fuzzed::x3p, x3p_of(binary_xml(), 0)},
      {"x3p", "x3p, deflated", fuzzed::x3p, x3p_of(binary_xml(), 8)},
      {"x3p", "x3p, listed", fuzzed::x3p, x3p_of(listed_xml(), 0)},
      {"sur", "sur, 16 bits", fuzzed::sur, build_sur(small_sur(0, 16))},
      {"sur", "sur, 32 bits", fuzzed::sur, build_sur(small_sur(0, 32))},
      {"sur", "sur, compressed", fuzzed::sur, build_sur(small_sur(2, 32))},
      {"sdf", "sdf, binary", fuzzed::sdf, binary_sdf("bISO-1.0")},
      {"sdf", "sdf, wide", fuzzed::sdf, binary_sdf("bISO-2.0")},
      {"sdf", "sdf, old", fuzzed::sdf, binary_sdf("bBCR-1.0")},
      {"opd", "opd", fuzzed::opd, small_opd()},
  };
  for (std::vector<Victim>& more : std::vector<std::vector<Victim>>{pictures(), texts()}) {
    for (Victim& victim : more) all.push_back(std::move(victim));
  }
  return all;
}

}  // namespace mezzotint::test
