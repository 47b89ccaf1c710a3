# OpenVDB is optional: gives the target ensonify_openvdb and ENSONIFY_HAS_OPENVDB where the library is installed.
# Found by hand: the module that OpenVDB brings along replaces find modules of other packages.
find_path(ENSONIFY_OPENVDB_INCLUDE openvdb/openvdb.h)
find_library(ENSONIFY_OPENVDB_LIBRARY openvdb)
# Its headers need Boost's, which Debian's libopenvdb-dev does not bring along.
find_path(ENSONIFY_OPENVDB_BOOST boost/numeric/conversion/conversion_traits.hpp)
mark_as_advanced(ENSONIFY_OPENVDB_INCLUDE ENSONIFY_OPENVDB_LIBRARY ENSONIFY_OPENVDB_BOOST)

if(NOT TARGET ensonify_openvdb)
  add_library(ensonify_openvdb INTERFACE)
  if(ENSONIFY_OPENVDB_INCLUDE AND ENSONIFY_OPENVDB_LIBRARY AND ENSONIFY_OPENVDB_BOOST)
    target_include_directories(ensonify_openvdb SYSTEM INTERFACE ${ENSONIFY_OPENVDB_INCLUDE} ${ENSONIFY_OPENVDB_BOOST})
    target_link_libraries(ensonify_openvdb INTERFACE ${ENSONIFY_OPENVDB_LIBRARY} TBB::tbb Imath::Imath)
    target_compile_definitions(ensonify_openvdb INTERFACE ENSONIFY_HAS_OPENVDB)
  endif()
endif()
