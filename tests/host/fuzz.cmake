# libFuzzer, by clang: the fuzz target over the shared library. PLM_FUZZ_SECONDS in the environment of ctest goes before
# the option (tests/run.sh --all: 60 in preset dev).
set(PLM_FUZZ_SECONDS 20 CACHE STRING "Seconds of fuzzing in the test host.fuzz")
option(PLM_FUZZ_INSTRUMENTED "host.fuzz follows the branches of the library, too: clang builds it once more, instrumented" OFF)
find_program(PLM_CLANG NAMES clang clang-14 clang-15 clang-16)
find_program(PLM_CLANGXX NAMES clang++ clang++-14 clang++-15 clang++-16)
if(PLM_SANITIZE)
    add_skipped_host_test(fuzz "the sanitizer runtimes of clang and gcc do not mix")
elseif(NOT PLM_CLANG OR NOT PLM_CLANGXX)
    add_skipped_host_test(fuzz "no clang")
else()
    set(fuzzed $<TARGET_FILE:plm>)
    if(PLM_FUZZ_INSTRUMENTED)
        set(build ${CMAKE_CURRENT_BINARY_DIR}/fuzz_library)
        set(fuzzed ${build}/src/libplm.so)
        add_host_test(fuzz_library sh ${here}/fuzz_library.sh ${CMAKE_COMMAND} ${CMAKE_GENERATOR} ${PLM_CLANG} ${PLM_CLANGXX}
                      ${PROJECT_SOURCE_DIR} ${build} -DPLM_WITH_CHOLMOD=${PLM_WITH_CHOLMOD} -DPLM_WITH_FFTW=${PLM_WITH_FFTW}
                      -DPLM_WITH_TRANSIENT=${PLM_WITH_TRANSIENT} -DPLM_WITH_STUDY=${PLM_WITH_STUDY})
        set_tests_properties(host.fuzz_library PROPERTIES FIXTURES_SETUP plm_fuzz_library PROCESSORS 2 TIMEOUT 900)
    endif()
    add_host_test(fuzz sh ${here}/fuzz.sh ${PLM_CLANG} ${PROJECT_SOURCE_DIR}/include ${fuzzed}
                  ${CMAKE_CURRENT_BINARY_DIR}/fuzz ${PLM_FUZZ_SECONDS})
    if(PLM_FUZZ_INSTRUMENTED)
        set_tests_properties(host.fuzz PROPERTIES FIXTURES_REQUIRED plm_fuzz_library)
    endif()
endif()
