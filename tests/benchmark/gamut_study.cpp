// scratch
#include <chrono>
#include <cmath>
#include <cstdio>
#include <fmt/format.h>
#include "inverse/gamut/gamut_map.h"
using namespace mezzotint;
static double now(){return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();}
int main(){
  PrinterProfile printer;
  GamutMapOptions o; o.blur_factors={1.0}; o.rays=7; o.edge_heights=4;
  std::vector<std::vector<double>> rows;
  double total=0;
  for(size_t i=0;i<gamut_task_count(o);++i){ double t=now(); rows.push_back(run_gamut_task(o,printer,i)); t=now()-t; total+=t; fmt::print("{}: {:.2f} s\n",gamut_task_name(o,i),t);}
  fmt::print("total {}\n",total);
  GamutMap m=assemble_gamut(o,printer,rows);
  for(auto&r:m.regions){ fmt::print("{}\n",r.kind);
   for(auto*l:{&r.stretched,&r.steepest}){ for(auto&p:*l){ fmt::print("  {:.4g} {:.4g} ±{:.3g} :",p.alpha.x,p.alpha.y,p.tolerance); for(double v:p.values) fmt::print(" {:.4g}",v); fmt::print("\n");} fmt::print("  --\n");}
  }
}
