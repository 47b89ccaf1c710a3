"""Trains the learned filter: /usr/bin/python3 -m ensonify.training --help, and docs/learned_filter.md.

Needs python3-torch, which nothing else in ensonify imports.
"""
