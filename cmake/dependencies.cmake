# Every library is a Debian 12 package; packages.txt lists them.
find_package(Threads REQUIRED)
find_package(Eigen3 3.4 REQUIRED NO_MODULE)
find_package(fmt REQUIRED)
find_package(nlohmann_json REQUIRED)
# An enum in JSON is its text. Without this the library would write its number, and nobody would be told.
set_property(TARGET nlohmann_json::nlohmann_json APPEND PROPERTY INTERFACE_COMPILE_DEFINITIONS JSON_DISABLE_ENUM_SERIALIZATION=1)
find_package(PkgConfig REQUIRED)
pkg_check_modules(gsl REQUIRED IMPORTED_TARGET gsl)
pkg_check_modules(nlopt REQUIRED IMPORTED_TARGET nlopt)
# Not `hdf5`: where an MPI build is installed too (LIGGGHTS brings one), Debian lets that name mean it, and it is neither
# thread-safe nor the one that netCDF uses.
pkg_check_modules(hdf5 REQUIRED IMPORTED_TARGET hdf5-serial)
pkg_check_modules(netcdf REQUIRED IMPORTED_TARGET netcdf)
pkg_check_modules(xxhash REQUIRED IMPORTED_TARGET libxxhash)
find_library(UDUNITS2_LIBRARY udunits2 REQUIRED)
find_package(tomlplusplus REQUIRED)
find_package(CLI11 REQUIRED)
find_package(SUNDIALS REQUIRED COMPONENTS cvode nvecserial)
