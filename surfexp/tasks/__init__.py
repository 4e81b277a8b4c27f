"""What a person does with a surface, one task a module; `import surfexp` offers them all."""
