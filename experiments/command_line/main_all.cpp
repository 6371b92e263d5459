#include "experiments/command_line/program.h"
#include "experiments/command_line/slice_appearance.h"
#include "forward/base/freed_memory.h"

namespace mezzotint {

std::span<const AddCommand> command_table() {
  static constexpr AddCommand commands[] = {
      add_run,        add_design,      add_info,     add_convert, add_measure,    add_correct,   add_roughness,
      add_synthesize, add_texture_fit, add_mesh,     add_bsdf,    add_bsdf_table, add_repair,    add_slice,
      add_job,        add_print,       add_validate, add_chart,   add_gamut,      add_calibrate, add_expose};
  return commands;
}

ReadAppearance appearance_reader() { return read_slice_appearance; }

}  // namespace mezzotint

int main(int count, char** arguments) {
  mezzotint::keep_freed_memory();
  return mezzotint::run_program(count, arguments);
}
