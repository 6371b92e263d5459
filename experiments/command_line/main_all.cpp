#include "experiments/command_line/program.h"

namespace mezzotint {

std::span<const AddCommand> command_table() {
  static constexpr AddCommand commands[] = {add_run,     add_design,     add_info,       add_convert,     add_measure,
                                            add_correct, add_roughness,  add_synthesize, add_texture_fit, add_mesh,
                                            add_bsdf,    add_bsdf_table, add_repair,     add_slice,       add_job,
                                            add_print,   add_validate,   add_chart,      add_gamut};
  return commands;
}

}  // namespace mezzotint

int main(int count, char** arguments) { return mezzotint::run_program(count, arguments); }
