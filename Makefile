# make run, make test, make lint, make bench: nothing else to remember.

.PHONY: core
core: ## rebuild the Rust core in place
	cd hapticd/core && cargo build --release -p hapticd-py
	cp hapticd/core/target/release/lib_core.so hapticd/_core.abi3.so
