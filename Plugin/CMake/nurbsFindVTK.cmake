# Finds VTK: the one inside ParaView's SDK, or a plain one. Sets NURBS_VTK_FLAVOUR_FOUND.
#
# Debian's ParaView SDK is asked for the components that we use and no more: ParaView as a whole
# would ask for the development files of HDF5 and others that nothing here needs.

set(nurbs_vtk_components
  CommonCore
  CommonDataModel
  CommonExecutionModel
  CommonMath
  CommonMisc
  CommonSystem
  CommonTransforms
  FiltersCore
  FiltersExtraction
  FiltersGeneral
  FiltersGeometry
  FiltersModeling
  FiltersSources
  ImagingCore
  IOCore
  IOExport
  IOGeometry
  IOImage
  IOLegacy
  IOPLY
  IOParallelXML
  IOXML
  InteractionStyle
  InteractionWidgets
  ParallelCore
  RenderingAnnotation
  RenderingCore
  RenderingFreeType
  RenderingOpenGL2
  RenderingUI
  WrappingPythonCore
  Python
  opengl
  pugixml)

if (NOT NURBS_VTK_FLAVOUR MATCHES "^(auto|paraview|plain)$")
  message(FATAL_ERROR "NURBS_VTK_FLAVOUR is '${NURBS_VTK_FLAVOUR}'; use auto, paraview or plain")
endif ()

set(NURBS_VTK_FLAVOUR_FOUND "")
if (NOT NURBS_VTK_FLAVOUR STREQUAL "plain")
  file(GLOB sdk_candidates "/usr/lib/*/cmake/paraview-*" "/usr/lib/cmake/paraview-*")
  find_path(NURBS_PARAVIEW_SDK NAMES paraview-config.cmake ParaViewConfig.cmake
    HINTS ${ParaView_DIR} ${sdk_candidates}
    DOC "Folder of ParaView's paraview-config.cmake")
  mark_as_advanced(NURBS_PARAVIEW_SDK)
  if (NURBS_PARAVIEW_SDK)
    find_package(VTK 9.1 REQUIRED COMPONENTS ${nurbs_vtk_components}
      PATHS "${NURBS_PARAVIEW_SDK}/vtk" NO_DEFAULT_PATH)
    set(NURBS_VTK_FLAVOUR_FOUND "paraview")
  elseif (NURBS_VTK_FLAVOUR STREQUAL "paraview")
    message(FATAL_ERROR "ParaView's SDK was not found (Debian: paraview-dev). "
      "Set ParaView_DIR, or build on a plain VTK with -DNURBS_VTK_FLAVOUR=plain.")
  endif ()
endif ()
if (NOT NURBS_VTK_FLAVOUR_FOUND)
  find_package(VTK 9.1 REQUIRED COMPONENTS ${nurbs_vtk_components})
  set(NURBS_VTK_FLAVOUR_FOUND "plain")
endif ()
message(STATUS "VTK ${VTK_VERSION}, ${NURBS_VTK_FLAVOUR_FOUND} flavour: ${VTK_DIR}")
