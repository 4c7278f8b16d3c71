# Candela: deps · all · demo · gallery · test · bench · check · soak · install · clean
#
# `make demo` and `make test` are all that a newcomer needs. Everything that is built lies in $(B).

B ?= build
PREFIX ?= /usr/local
DESTDIR ?=
JOBS ?= $(shell nproc)
VERSION := $(shell sed -n 's/^.define CDL_VERSION "\(.*\)"/\1/p' host/candela.h)

.DEFAULT_GOAL := all
.DELETE_ON_ERROR:
.SUFFIXES:
.PHONY: deps all demo gallery test bench check soak install clean \
  run-demo run-gallery run-test run-bench run-check run-soak run-host format-check lint tests

ifeq ($(MAKELEVEL),0)
# A -j on the command line wins.
MAKEFLAGS += -j$(JOBS)
endif

# --- What the user asks for: dependencies first, then a second make that can find them.

deps:
	@scripts/setup.sh build test bench check

demo: ; @scripts/setup.sh build && $(MAKE) --no-print-directory run-demo
gallery: ; @scripts/setup.sh build && $(MAKE) --no-print-directory run-gallery
test: ; @scripts/setup.sh build test && $(MAKE) --no-print-directory run-test
soak: ; @scripts/setup.sh build test && $(MAKE) --no-print-directory run-soak
bench: ; @scripts/setup.sh build bench && $(MAKE) --no-print-directory run-bench
check: ; @scripts/setup.sh build test check && $(MAKE) --no-print-directory run-check

clean:
	rm -rf $(B)

# --- How things are compiled.

PACKAGES := OpenImageIO libpng jansson nettle OpenCL tinygltf draco Imath
NEEDS_COMPILER := $(filter-out deps demo gallery test bench check soak clean,$(or $(MAKECMDGOALS),all))
ifneq ($(NEEDS_COMPILER),)
PACKAGE_CFLAGS := $(shell pkg-config --cflags $(PACKAGES))
PACKAGE_LIBS := $(shell pkg-config --libs $(PACKAGES))
endif

CC := gcc
CXX := g++
SANITIZE ?=
# One short line for each file; V=1 shows the commands.
V ?=
SAY = $(if $(V),,@echo "  $(1)	$(2)";)
CPPFLAGS += -Ihost -Ikernels -I$(B) $(PACKAGE_CFLAGS)
COMMON := -O2 -g -Wall -Wextra -Werror -ffp-contract=off -fopenmp -fPIC -fvisibility=hidden
COMMON += -MMD -MP $(if $(SANITIZE),-fsanitize=$(SANITIZE) -fno-sanitize-recover=all)
ALL_CFLAGS = -std=gnu11 $(COMMON) $(CFLAGS)
ALL_CXXFLAGS = -std=c++17 $(COMMON) $(CXXFLAGS)
LINK = $(CXX) -fopenmp $(if $(SANITIZE),-fsanitize=$(SANITIZE)) $(LDFLAGS)
# meshoptimizer and OpenVDB have no pkg-config files; OpenVDB needs TBB and Imath.
LIBS := $(PACKAGE_LIBS) -lmeshoptimizer -lopenvdb -ltbb -lm -lpthread

LIB_SOURCES := $(filter-out host/cli/%,$(wildcard host/*/*.c host/*/*.cpp))
LIB_OBJECTS := $(LIB_SOURCES:%=$(B)/obj/%.o) $(B)/obj/kernel_sources.c.o
CLI_OBJECTS := $(patsubst %,$(B)/obj/%.o,$(wildcard host/cli/*.c))
SONAME := libcandela.so.$(firstword $(subst ., ,$(VERSION)))

all: $(B)/candela $(B)/libcandela.a $(B)/libcandela.so

$(B)/obj/%.c.o: %.c Makefile
	@mkdir -p $(@D)
	$(call SAY,CC,$<)$(CC) $(CPPFLAGS) $(ALL_CFLAGS) -c $< -o $@

$(B)/obj/%.cpp.o: %.cpp Makefile
	@mkdir -p $(@D)
	$(call SAY,CXX,$<)$(CXX) $(CPPFLAGS) $(ALL_CXXFLAGS) -c $< -o $@

$(B)/obj/kernel_sources.c.o: $(B)/kernel_sources.c Makefile
	@mkdir -p $(@D)
	$(call SAY,CC,$<)$(CC) $(CPPFLAGS) $(ALL_CFLAGS) -c $< -o $@

# The script leaves files alone that would not change, so a stamp says when it last ran; folders are
# listed so that a removed kernel is noticed as well.
KERNEL_FILES := $(shell find kernels -type d -o -name '*.cl' -o -name '*.h')
$(B)/kernel_sources.stamp: scripts/embed_kernels.sh $(KERNEL_FILES)
	@mkdir -p $(B)
	$(call SAY,EMBED,kernels)scripts/embed_kernels.sh kernels $(B)/kernel_sources.c $(B)/abi_fields.h
	@touch $@
$(B)/kernel_sources.c $(B)/abi_fields.h: $(B)/kernel_sources.stamp ;

$(B)/libcandela.a: $(LIB_OBJECTS)
	@rm -f $@
	$(call SAY,AR,$@)ar qcs $@ $^

$(B)/libcandela.so: $(LIB_OBJECTS)
	$(call SAY,LINK,$@)$(LINK) -shared -Wl,-soname,$(SONAME) -Wl,--no-undefined $^ $(LIBS) -o $@

$(B)/candela: $(CLI_OBJECTS) $(B)/libcandela.a
	$(call SAY,LINK,$@)$(LINK) $^ $(LIBS) -o $@

# --- Tests: tests/FOLDER/test_NAME.c is a program; other .c and .cpp files there are linked into each.

TEST_SOURCES := $(wildcard tests/*/test_*.c)
TEST_PROGRAMS := $(TEST_SOURCES:tests/%.c=$(B)/tests/%)
TEST_SCRIPTS := $(filter-out %/common.sh %/common.py,$(wildcard tests/*/*.sh tests/*/*.py))
# What needs no device: the programs that the sanitizers watch.
HOST_PROGRAMS := $(filter $(B)/tests/unit/% $(B)/tests/bad_input/% $(B)/tests/compression/% \
  $(B)/tests/volume/%,$(TEST_PROGRAMS))
test_helpers = $(patsubst %,$(B)/obj/%.o,$(filter-out tests/$(1)/test_%,$(wildcard tests/$(1)/*.c tests/$(1)/*.cpp)))

tests: $(TEST_PROGRAMS)
$(B)/obj/tests/%: CPPFLAGS += -I.

.SECONDARY: $(TEST_SOURCES:%=$(B)/obj/%.o)
$(TEST_SOURCES:%=$(B)/obj/%.o): $(B)/kernel_sources.stamp

.SECONDEXPANSION:
$(TEST_PROGRAMS): $(B)/tests/%: $(B)/obj/tests/%.c.o $$(call test_helpers,$$(firstword $$(subst /, ,$$*))) \
  $(B)/libcandela.a
	@mkdir -p $(@D)
	$(call SAY,LINK,$@)$(LINK) $^ $(LIBS) -lcmocka -o $@

run-test: all tests
	@CANDELA=$(B)/candela tests/run.sh $(B)/tests $(TEST_PROGRAMS) $(TEST_SCRIPTS)

# The same tests with the sizes and times of a long run; they read CDL_SOAK.
run-soak: all tests
	@CDL_SOAK=1 TEST_TIMEOUT=7200 CANDELA=$(B)/candela \
	  tests/run.sh $(B)/tests $(TEST_PROGRAMS) $(TEST_SCRIPTS)

run-host: $(HOST_PROGRAMS)
	@tests/run.sh $(B)/tests $(HOST_PROGRAMS)

# --- Benchmarks: scripts/bench_NAME.c(pp) is a program that may use Embree.

BENCH_SOURCES := $(wildcard scripts/bench_*.c scripts/bench_*.cpp)
BENCH_PROGRAMS := $(sort $(patsubst scripts/%,$(B)/bench/%,$(basename $(BENCH_SOURCES))))

$(BENCH_PROGRAMS): $(B)/bench/%: $$(patsubst $$(percent),$(B)/obj/$$(percent).o,$$(wildcard scripts/$$*.c scripts/$$*.cpp)) \
  $(B)/libcandela.a
	@mkdir -p $(@D)
	$(call SAY,LINK,$@)$(LINK) $^ $(LIBS) -lembree3 -o $@
percent := %

run-bench: all $(BENCH_PROGRAMS)
	@set -e; for b in $(BENCH_PROGRAMS); do echo "# $${b##*/}"; $$b; done
	@CANDELA=$(B)/candela scripts/bench.sh

# --- Checks: format, static analysis, and the host's tests under the sanitizers.

C_FILES = $(shell find host kernels tests scripts -name '*.[ch]' -o -name '*.cpp' -o -name '*.cl')

format-check:
	@clang-format --dry-run -Werror $(C_FILES)

# cppcheck does not see that a loop downwards fills what the next one reads (bvh/tree.c).
lint:
	@cppcheck --quiet --error-exitcode=1 --std=c11 --enable=warning,performance,portability \
	  --library=scripts/cppcheck.cfg --inline-suppr --suppress=missingIncludeSystem \
	  --suppress=uninitvar:host/bvh/tree.c -Ihost -Ikernels $(wildcard host/*/*.c)

run-check: format-check lint
	@OMP_NUM_THREADS=2 $(MAKE) --no-print-directory B=$(B)/asan SANITIZE=address,undefined run-host

# --- A picture.

run-demo: all
	@$(B)/candela render scenes/demo.gltf -o $(B)/demo.png --size 960x --spp 96 --tonemap aces --profile
	@echo "The picture is in $(B)/demo.png"

# A page of all materials, in one file.
run-gallery: all
	@CANDELA=$(B)/candela scripts/gallery.py -o $(B)/gallery.html

# --- Installation.

install: all
	install -D -m 755 $(B)/candela $(DESTDIR)$(PREFIX)/bin/candela
	install -D -m 644 host/candela.h $(DESTDIR)$(PREFIX)/include/candela.h
	install -D -m 644 $(B)/libcandela.a $(DESTDIR)$(PREFIX)/lib/libcandela.a
	install -D -m 755 $(B)/libcandela.so $(DESTDIR)$(PREFIX)/lib/libcandela.so.$(VERSION)
	ln -sf libcandela.so.$(VERSION) $(DESTDIR)$(PREFIX)/lib/$(SONAME)
	ln -sf $(SONAME) $(DESTDIR)$(PREFIX)/lib/libcandela.so
	install -D -m 644 scripts/candela.1 $(DESTDIR)$(PREFIX)/share/man/man1/candela.1
	install -d $(DESTDIR)$(PREFIX)/lib/pkgconfig
	sed -e 's|@PREFIX@|$(PREFIX)|' -e 's|@VERSION@|$(VERSION)|' scripts/candela.pc.in \
	  > $(DESTDIR)$(PREFIX)/lib/pkgconfig/candela.pc

-include $(shell find $(B)/obj -name '*.d' 2>/dev/null)
