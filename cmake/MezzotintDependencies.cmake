# Every library that we use, found the way it asks to be found. Debian 12's versions.

find_package(Eigen3 3.4 REQUIRED NO_MODULE)
# After Eigen: CGAL's own way to find Eigen hides its target. Only fabrication/repair includes CGAL.
set(CGAL_DO_NOT_WARN_ABOUT_CMAKE_BUILD_TYPE TRUE)
option(BUILD_TESTING "Build the testing tree." ON)  # or CGAL's files would turn it off in a fresh build folder
find_package(CGAL 5.5 REQUIRED)
find_package(embree 3 REQUIRED)
find_package(NLopt REQUIRED)
find_package(TBB REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(fmt REQUIRED)
find_package(spdlog REQUIRED)
find_package(pugixml REQUIRED)
find_package(ZLIB REQUIRED)
find_package(PNG REQUIRED)
find_package(Threads REQUIRED)
# Optional: sweeps over several processes and machines.
find_package(MPI QUIET COMPONENTS C)
option(MEZZOTINT_MPI "Spread sweeps over MPI ranks" ${MPI_C_FOUND})
if(MEZZOTINT_MPI AND NOT MPI_C_FOUND)
  message(FATAL_ERROR "MEZZOTINT_MPI needs MPI (Debian: libopenmpi-dev)")
endif()

find_package(OpenImageIO REQUIRED)
# Debian's target names a folder of OpenCV headers that is not there; CMake would refuse the target.
get_target_property(_includes OpenImageIO::OpenImageIO INTERFACE_INCLUDE_DIRECTORIES)
list(FILTER _includes EXCLUDE REGEX "opencv")
set_target_properties(OpenImageIO::OpenImageIO PROPERTIES INTERFACE_INCLUDE_DIRECTORIES "${_includes}")

find_package(PkgConfig REQUIRED)
pkg_check_modules(FFTW REQUIRED IMPORTED_TARGET fftw3)
pkg_check_modules(ZIP REQUIRED IMPORTED_TARGET libzip)
pkg_check_modules(DEFLATE REQUIRED IMPORTED_TARGET libdeflate)
pkg_check_modules(LIB3MF REQUIRED IMPORTED_TARGET lib3MF)
pkg_check_modules(TOMLPLUSPLUS REQUIRED IMPORTED_TARGET tomlplusplus)
pkg_check_modules(SERIALPORT REQUIRED IMPORTED_TARGET libserialport)
pkg_check_modules(NETTLE REQUIRED IMPORTED_TARGET nettle)
pkg_check_modules(LIBUSB REQUIRED IMPORTED_TARGET libusb-1.0)
pkg_check_modules(SDL2 REQUIRED IMPORTED_TARGET sdl2)

# NLopt's package configuration names only the C library, which lacks StoGO and AGS.
find_library(NLOPT_CXX_LIBRARY nlopt_cxx REQUIRED)
add_library(mezzotint_nlopt INTERFACE)
target_link_libraries(mezzotint_nlopt INTERFACE ${NLOPT_CXX_LIBRARY})

# SIMD with run-time dispatch. Debian's pkg-config file links the library; nothing else is needed.
pkg_check_modules(HWY REQUIRED IMPORTED_TARGET libhwy)
add_library(hwy::hwy ALIAS PkgConfig::HWY)
# The baseline of x86-64, AVX2 and AVX-512: what lies between gains nothing here and costs compile time.
target_compile_definitions(PkgConfig::HWY INTERFACE "HWY_DISABLED_TARGETS=(HWY_SSSE3|HWY_SSE4|HWY_AVX3_DL)")
