# With FABA_ENGINE_ONLY: the tests of the folders of the engine (CMakeLists.txt), linked with the engine.
set(tested core field sim control vision/image vision/foreground rig/setup rig/simulated app/loop app/scenario app/run
    contract physics golden)
# These need HDF5, videos or a run directory.
set(of_program core/h5/ core/storage_test control/image_estimators_test app/run/live_run_test)
list(JOIN of_program "|" of_program)

foreach(folder ${tested})
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${folder}/*_test.cpp)
  list(FILTER sources EXCLUDE REGEX "${of_program}")
  string(REGEX REPLACE "/.*" "" group ${folder})
  list(APPEND groups ${group})
  list(APPEND sources_of_${group} ${sources})
endforeach()
list(REMOVE_DUPLICATES groups)
foreach(group ${groups})
  faba_tests(${group} "${sources_of_${group}}" faba_engine)
  target_sources(tests_${group} PRIVATE engine/program_parts.cpp)
endforeach()

# Under emulation some tests would take tens of minutes: controllers are tested with their defaults only; the comparison of
# kalman on rendered pictures is left out, and ctest lists the file with it as disabled; so it does with vision.foreground,
# of which the frames of the golden tests are the result.
if(CMAKE_CROSSCOMPILING)
  set_tests_properties(contract.controllers PROPERTIES ENVIRONMENT FABA_DEFAULTS_ONLY=1)
  set_tests_properties(control.kalman vision.foreground PROPERTIES DISABLED ON)
  add_test(NAME control.kalman_without_pictures COMMAND tests_control --source-file=*/kalman_test.cpp "--test-case-exclude=*rendered pictures*")
  # Those that compute for many minutes start first. ctest would stop a test after 25 minutes.
  set_tests_properties(physics.dipole physics.trap control.mixture control.rotating_hold contract.controllers
                       PROPERTIES COST 1000 TIMEOUT 5400)
  set_property(TEST physics.dipole physics.trap APPEND PROPERTY LABELS long)
endif()
