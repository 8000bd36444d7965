# How every object of the project is compiled.
set(CMAKE_CXX_STANDARD 17)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_C_STANDARD 99)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
set(CMAKE_C_VISIBILITY_PRESET hidden)
set(CMAKE_CXX_VISIBILITY_PRESET hidden)
set(CMAKE_VISIBILITY_INLINES_HIDDEN ON)
if(PROJECT_IS_TOP_LEVEL AND NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
    set(CMAKE_BUILD_TYPE Release CACHE STRING "Build type" FORCE)
endif()
if(PROJECT_IS_TOP_LEVEL)
    add_compile_options(-Wall -Wextra)
endif()
if(PLM_CHECKED)
    add_compile_definitions($<$<COMPILE_LANGUAGE:CXX>:PLM_CHECKED> $<$<COMPILE_LANGUAGE:CXX>:_GLIBCXX_ASSERTIONS>)
endif()
# What is installed checks its own stack and copies, in the host's interest.
if(NOT PLM_SANITIZE)
    add_compile_options("$<$<CONFIG:Release,MinSizeRel>:-fstack-protector-strong;-fstack-clash-protection>"
                        "$<$<CONFIG:Release,MinSizeRel>:-U_FORTIFY_SOURCE;-D_FORTIFY_SOURCE=2>") # Ubuntu's gcc defines it
endif()
if(PLM_SANITIZE)
    add_compile_options(-fsanitize=${PLM_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all)
    add_link_options(-fsanitize=${PLM_SANITIZE})
    if(CMAKE_CXX_COMPILER_ID STREQUAL Clang) # its runtime stands in programs, those in C included, with the part for C++
        string(REPLACE "<CMAKE_C_COMPILER>" "<CMAKE_CXX_COMPILER>" CMAKE_C_LINK_EXECUTABLE "${CMAKE_C_LINK_EXECUTABLE}")
    endif()
endif()

# One room of src/: an object library whose headers are included as "room/file.hpp".
function(plm_room room)
    cmake_parse_arguments(ARG "" "" "SOURCES;LINK" ${ARGN})
    add_library(plm_${room} OBJECT ${ARG_SOURCES})
    target_include_directories(plm_${room} PUBLIC ${PROJECT_SOURCE_DIR}/src ${PROJECT_SOURCE_DIR}/include)
    target_link_libraries(plm_${room} PUBLIC ${ARG_LINK})
    # most of a small file's time goes to its headers
    set_target_properties(plm_${room} PROPERTIES UNITY_BUILD ${PLM_UNITY} UNITY_BUILD_BATCH_SIZE 12)
endfunction()
