#pragma once

#include <map>
#include <string>

#include "tests/measurement/reflectance/tensor_builder.h"

// A small whole file of every format, to be damaged; also the seeds of the fuzz targets.
namespace mezzotint::test {

inline const char* const small_zemax =
    "# Sample: none\nSource\tMeasured\nSymmetry\tPlaneSymmetrical\nSpectralContent\tMonochrome\nScatterType\tBRDF\n"
    "SampleRotation\t1\n0\nAngleOfIncidence\t2\n0\t40\nScatterAzimuth\t3\n0\t90\t180\nScatterRadial\t2\n0\t30\n\n"
    "Monochrome\nDataBegin\nTIS\t0.1\n1.0\t0.5\n1.0\t0.4\n1.0\t0.3\nTIS\t0.2\n2.0\t1.5\n2.0\t1.4\n2.0\t0.0\nDataEnd\n";

inline const char* const small_fred =
    "type bsdf_data\nformat angles=deg bsdf=value scale=2\n30 0\n0 0 1\n20 0 0.5\n20 90 0.4\n20 180 0.3\n40 0 0.2\n"
    "40 90 0.1\n40 180 0.05\n";

inline const char* const small_cornell =
    "# A paint\n# num wls\n2\n\n# wls\n500\n600\n\n# rows\n0.5 0 0.1 0 1 2\n0.5 0 0.5 0 3 4\n0.5 0 0.5 1.5 5 6\n"
    "0.5 0 0.5 3.14159 7 8\n";

inline const char* const small_alta =
    "#SAMPLE \"x\"\n#DIM 3 1\n#VS 0\n#PARAM_IN ISOTROPIC_TL_TV_PROJ_DPHI\n0.5 0 0 1\n0.5 0.5 0 2\n0.5 0 0.5 3\n"
    "0.5 0 -0.5 3\n";

inline std::map<std::string, std::string> small_files() {
  return {{"rgl", packed(tensor_of(BeckmannLobe{}, {.theta = 2, .visible = 4, .samples = 4, .normals = 4}))},
          {"zemax", small_zemax},
          {"fred", small_fred},
          {"cornell", small_cornell},
          {"alta", small_alta}};
}

}  // namespace mezzotint::test
