# Debian's per-module OpenCV packages (libopencv-core-dev, ...) come without OpenCVConfig.cmake, which only the whole
# libopencv-dev has. Finds the modules asked for as components: find_package(OpenCVModules COMPONENTS core imgproc)
# gives OpenCV::core, OpenCV::imgproc.
find_path(OpenCVModules_INCLUDE_DIR opencv2/core.hpp PATH_SUFFIXES opencv4)
set(opencv_needed OpenCVModules_INCLUDE_DIR)
foreach(module ${OpenCVModules_FIND_COMPONENTS})
  find_library(OpenCVModules_${module}_LIBRARY opencv_${module})
  list(APPEND opencv_needed OpenCVModules_${module}_LIBRARY)
endforeach()

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(OpenCVModules REQUIRED_VARS ${opencv_needed})

foreach(module ${OpenCVModules_FIND_COMPONENTS})
  if(OpenCVModules_FOUND AND NOT TARGET OpenCV::${module})
    add_library(OpenCV::${module} UNKNOWN IMPORTED)
    set_target_properties(OpenCV::${module} PROPERTIES
      IMPORTED_LOCATION ${OpenCVModules_${module}_LIBRARY}
      INTERFACE_INCLUDE_DIRECTORIES ${OpenCVModules_INCLUDE_DIR})
  endif()
endforeach()
