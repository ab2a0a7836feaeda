# Installs BUILD into a scratch folder, builds the project in Package/ against it, and runs that.
set(scratch "${BUILD}/Testing/Output/Package")
file(REMOVE_RECURSE "${scratch}")
set(prefix "${scratch}/prefix")

function (run)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE status OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if (NOT status EQUAL 0)
    list(JOIN ARGN " " command)
    message(FATAL_ERROR "${command}\n${output}")
  endif ()
endfunction ()

run("${CMAKE_COMMAND}" --install "${BUILD}" --prefix "${prefix}")
# The build tree must not be what is found: no path to it may be in what was installed.
file(GLOB_RECURSE configs "${prefix}/*.cmake")
foreach (config IN LISTS configs)
  file(READ "${config}" text)
  string(FIND "${text}" "${BUILD}/lib" in_build)
  string(FIND "${text}" "${SOURCE}/Filters" in_source)
  if (NOT in_build EQUAL -1 OR NOT in_source EQUAL -1)
    message(FATAL_ERROR "${config} points into the build or source tree")
  endif ()
endforeach ()
run("${CMAKE_COMMAND}" -G Ninja -S "${CMAKE_CURRENT_LIST_DIR}/Package" -B "${scratch}/build"
  "-DCMAKE_PREFIX_PATH=${prefix}" -DCMAKE_BUILD_TYPE=Release "-DCMAKE_CXX_COMPILER=${COMPILER}")
run("${CMAKE_COMMAND}" --build "${scratch}/build")
if (PYTHON)
  # A Python program that has nothing of the build tree.
  run("${CMAKE_COMMAND}" -E env "PYTHONPATH=${prefix}/lib/python3/dist-packages" "${PYTHON}"
    "${CMAKE_CURRENT_LIST_DIR}/TestPythonArrays.py")
endif ()
if (PVPYTHON)
  # ParaView's plugin where it was installed, with the libraries and the Python package beside it.
  file(GLOB plugin "${prefix}/*/paraview-*/plugins/NURBS/NURBS.so")
  run("${CMAKE_COMMAND}" -E env "PYTHONPATH=${prefix}/lib/python3/dist-packages" "${PVPYTHON}"
    "${CMAKE_CURRENT_LIST_DIR}/ParaView/TestDefaults.py" "${plugin}" "${scratch}")
endif ()
foreach (program kernel pipeline)
  if (EXISTS "${scratch}/build/${program}")
    run("${scratch}/build/${program}")
  endif ()
endforeach ()
