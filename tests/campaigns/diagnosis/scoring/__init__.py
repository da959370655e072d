"""Runs `flexcomp diagnose` on generated cases and counts how often it is right."""
