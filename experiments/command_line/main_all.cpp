#include "experiments/command_line/program.h"
#include "experiments/command_line/slice_appearance.h"

namespace mezzotint {

std::span<const AddCommand> command_table() {
  static constexpr AddCommand commands[] = {add_run,     add_design,    add_info,       add_convert,     add_measure,
                                            add_correct, add_roughness, add_synthesize, add_texture_fit, add_mesh,
                                            add_expose,  add_bsdf,      add_bsdf_table, add_repair,      add_slice,
                                            add_job,     add_print,     add_validate,   add_chart,       add_gamut};
  return commands;
}

ReadAppearance appearance_reader() { return read_slice_appearance; }

}  // namespace mezzotint

int main(int count, char** arguments) { return mezzotint::run_program(count, arguments); }
