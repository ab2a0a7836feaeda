# The ParaView plugin NURBS (Plugin/ParaView), where the VTK we build on is ParaView's.

if (NOT NURBS_PARAVIEW_PLUGIN OR NOT NURBS_VTK_FLAVOUR_FOUND STREQUAL "paraview")
  return ()
endif ()

# Only what the plugin links: ParaView as a whole would ask for more development files than Debian's
# package brings (Documentation/decisions/vtk-of-paraview.md).
set(ParaView_DIR "${NURBS_PARAVIEW_SDK}")
set(paraview_components RemotingViews)
if (NURBS_PARAVIEW_WIDGETS)
  list(APPEND paraview_components pqComponents)
  find_package(Qt5 REQUIRED COMPONENTS Widgets)
  find_package(Boost REQUIRED)
  find_package(LibXml2 REQUIRED)
  # ParaView's Qt libraries name these in their link interfaces; nothing here includes their headers.
  foreach (target NetCDF::NetCDF Qt5::OpenGL hdf5::hdf5 hdf5::hdf5_hl)
    if (NOT TARGET "${target}")
      add_library("${target}" INTERFACE IMPORTED)
    endif ()
  endforeach ()
endif ()
find_package(ParaView 5.11 REQUIRED COMPONENTS ${paraview_components})
if (NURBS_PARAVIEW_WIDGETS)
  # The base of widgets in the view is in this library, whose component would ask for what is not in
  # Debian's package. Its headers are beside the others.
  find_library(NURBS_PARAVIEW_APPLICATION
    NAMES "pqApplicationComponents-pv${ParaView_VERSION_MAJOR}.${ParaView_VERSION_MINOR}" pqApplicationComponents
    HINTS "${ParaView_PREFIX_PATH}/${CMAKE_INSTALL_LIBDIR}" "${ParaView_PREFIX_PATH}/lib" REQUIRED)
  mark_as_advanced(NURBS_PARAVIEW_APPLICATION)
endif ()
message(STATUS "ParaView ${ParaView_VERSION}: ${ParaView_DIR}")

paraview_plugin_scan(
  PLUGIN_FILES "${PROJECT_SOURCE_DIR}/Plugin/ParaView/paraview.plugin"
  PROVIDES_PLUGINS nurbs_plugins
  ENABLE_BY_DEFAULT ON
  HIDE_PLUGINS_FROM_CACHE ON)
paraview_plugin_build(
  PLUGINS ${nurbs_plugins}
  PLUGINS_COMPONENT paraview
  LIBRARY_SUBDIRECTORY "${PARAVIEW_PLUGIN_SUBDIR}"
  INSTALL_HEADERS OFF
  DISABLE_XML_DOCUMENTATION ON)
