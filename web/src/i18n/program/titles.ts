/** Portuguese titles of values, sections and parts of a scenario, by their English title. */
export const titles: Record<string, string> = {
  // Sections and parts
  Swarm: 'Enxame', Model: 'Modelo', Start: 'Posições iniciais', Arena: 'Arena', Controller: 'Controlador', Reference: 'Referência', Estimator: 'Estimador', Field: 'Campo',
  'Motility law': 'Lei de motilidade', Scale: 'Escala', Camera: 'Câmera', Microscope: 'Microscópio', Simulation: 'Simulação', Exclusion: 'Exclusão', Limits: 'Limites', Flow: 'Fluxo óptico',
  Record: 'Gravação', Rig: 'Bancada', Coil: 'Bobina', Segment: 'Segmento', Guard: 'Proteção', Driver: 'Acionamento', Channel: 'Canal', Source: 'Fonte', 'Step response': 'Resposta ao degrau',
  // Scenario and swarm
  Title: 'Título', Seed: 'Semente', Duration: 'Duração', 'Air exposure time': 'Tempo de exposição ao ar', 'Number of cells': 'Número de células', Polarity: 'Polaridade', 'Responsive fraction': 'Fração responsiva', Heading: 'Orientação',
  // Models
  Speed: 'Velocidade', 'Speed, standard deviation': 'Velocidade, desvio padrão', 'Speed max': 'Velocidade máxima', 'Noise amplitude': 'Amplitude do ruído', 'Maximum innate speed': 'Velocidade inata máxima',
  'Iterations per drawn velocity': 'Iterações por velocidade sorteada', 'Continuous speed': 'Velocidades reais', Earth: 'Campo da Terra', Moment: 'Momento magnético', 'Moment spread': 'Dispersão do momento', Radius: 'Raio',
  'Drag factor': 'Fator de arrasto', Viscosity: 'Viscosidade', Temperature: 'Temperatura', 'Rotational diffusion': 'Difusão rotacional', 'Translational diffusion': 'Difusão translacional', 'Motile fraction': 'Fração móvel',
  'Reversal rate': 'Taxa de reversão', 'Tumble rate': 'Taxa de tombos', 'Tumble, standard deviation': 'Tombo, desvio padrão',
  // Arena, start, reference
  Size: 'Tamanho', View: 'Vista', Centre: 'Centro', Depth: 'Profundidade', Visible: 'Visível', Direction: 'Direção', Positions: 'Posições', Scatter: 'Dispersão', Setpoint: 'Ponto de referência', Setpoints: 'Pontos de referência',
  Tolerance: 'Tolerância', 'Hold frames': 'Quadros de permanência', Timeout: 'Tempo limite', 'Wall alignment': 'Alinhamento à parede',
  // Controllers and estimators
  Gain: 'Ganho', 'Integral gain': 'Ganho integral', 'Integral time': 'Tempo integral', 'Max output': 'Comando máximo', 'Dead zone': 'Zona morta', 'Delay frames': 'Atraso em quadros', 'Frames per cell velocity': 'Quadros por velocidade de célula',
  'Swimming speed of the plant': 'Velocidade de nado da planta', 'Turning rate of the plant': 'Taxa de giro da planta', 'Rotational diffusion of the plant': 'Difusão rotacional da planta', 'Drift per tesla of the plant': 'Deriva por tesla da planta',
  'Rotating field': 'Campo girante', 'Loop gain': 'Ganho da malha', 'Setpoint of the second swarm': 'Ponto de referência do segundo enxame', 'Polarity of the first swarm': 'Polaridade do primeiro enxame', 'Initial position of the first swarm': 'Posição inicial do primeiro enxame',
  'Polarity of the second swarm': 'Polaridade do segundo enxame', 'Speed of the second swarm': 'Velocidade do segundo enxame', 'Turning rate of the second swarm': 'Taxa de giro do segundo enxame',
  'Drift per tesla of the second swarm': 'Deriva por tesla do segundo enxame',
  'Time without cells': 'Tempo sem células', 'Error of a position': 'Erro de uma posição', 'Distance worth the full command': 'Distância que vale o comando total', 'Velocity weight': 'Peso da velocidade', 'Frames per move': 'Quadros por movimento', Moves: 'Movimentos', Change: 'Mudança',
  'Distance from edges': 'Distância das bordas', 'Distance from obstacles': 'Distância dos obstáculos', Obstacles: 'Obstáculos', 'Heat of the coils': 'Calor das bobinas', Corners: 'Vértices',
  Actuation: 'Atuação', 'Prediction time': 'Tempo de predição', 'Near distance': 'Distância próxima', 'Far distance': 'Distância distante', 'Fuzzy states': 'Estados fuzzy', 'Direction of the command': 'Direção do comando', Current: 'Corrente',
  'Maximum displacement of the zero': 'Deslocamento máximo do zero', 'Maximum number of groups': 'Número máximo de grupos', Count: 'Número', Separation: 'Separação', At: 'Instante',
  Shape: 'Forma', Points: 'Pontos', Closed: 'Fechada', Text: 'Texto', 'Look-ahead distance': 'Distância de antecipação', Laps: 'Voltas', Transport: 'Transporte',
  Compact: 'Compacto', Spread: 'Disperso', Patience: 'Paciência', 'Speed fraction': 'Fração da velocidade',
  // Scale, camera, limits
  'Image scale': 'Escala da imagem', 'Duration of one iteration': 'Duração de uma iteração', 'Field unit': 'Unidade de campo', File: 'Arquivo', Rate: 'Taxa de quadros', Jitter: 'Variação do atraso', Sensor: 'Sensor', 'Max current': 'Corrente máxima',
  'Max slew': 'Variação máxima', 'Max frame age': 'Idade máxima do quadro', Step: 'Passo', Order: 'Ordem', 'Integer positions': 'Posições inteiras',
  // Microscope and record
  'Cell diameter': 'Diâmetro da célula', 'Cell length': 'Comprimento da célula', Contrast: 'Contraste', 'Exposure time': 'Tempo de exposição', 'Read noise': 'Ruído de leitura', Noise: 'Ruído', Background: 'Fundo', Mode: 'Modo', Level: 'Nível',
  Tracks: 'Trajetórias', 'Tracks every': 'Intervalo das trajetórias', Compress: 'Compactar', Video: 'Vídeo', 'Video every': 'Intervalo do vídeo', Lossless: 'Sem perdas', 'As seen': 'Como a câmera vê', Checkpoint: 'Ponto de retomada', Resolution: 'Resolução',
  // Other values of scenarios and the bench
  Halo: 'Halo', 'Halo width': 'Largura do halo', Emission: 'Emissão', 'Background emission': 'Emissão do fundo', 'Bleaching time': 'Tempo de fotobranqueamento',
  'PSF, standard deviation': 'PSF, desvio padrão', 'Depth spread': 'Dispersão em profundidade', 'Depth of field': 'Profundidade de campo', Vignetting: 'Vinhetagem', Unevenness: 'Desuniformidade',
  'Edge contrast': 'Contraste da borda', 'Edge width': 'Largura da borda', 'Outside level': 'Nível externo', Drift: 'Deriva', Flicker: 'Cintilação', 'Full well': 'Capacidade do poço', Bits: 'Bits',
  Follow: 'Seguimento', Collision: 'Colisão', Position: 'Posição', Axis: 'Eixo', Name: 'Nome', Resistance: 'Resistência', Inductance: 'Indutância', Distance: 'Distância', Turns: 'Espiras',
  Opposed: 'Opostas', 'Wire radius': 'Raio do fio', 'Measured current': 'Corrente medida', Within: 'Dentro de', Turn: 'Rotação', Expansion: 'Expansão', 'Half size': 'Metade do tamanho',
  Residual: 'Resíduo', Coefficients: 'Coeficientes', Length: 'Comprimento', 'Core permeability': 'Permeabilidade do núcleo', 'Core length': 'Comprimento do núcleo', 'Core radius': 'Raio do núcleo',
  'Inner radius': 'Raio interno', 'Outer radius': 'Raio externo', Lag: 'Atraso', Slowdown: 'Desaceleração', 'Tolerance sigma': 'Sigma da tolerância', 'Oxygen diffusivity': 'Difusividade do oxigênio',
  Tolerated: 'Tolerado', Near: 'Perto de', Cell: 'Célula', Cells: 'Células', 'Threshold, standard deviation': 'Limiar, desvios padrão', Absorb: 'Absorção', Learn: 'Aprendizado', Trapezoid: 'Trapézio',
  Output: 'Saída', Rotating: 'Parte girante', Frequency: 'Frequência', Quality: 'Qualidade', Levels: 'Níveis', Window: 'Janela', Iterations: 'Iterações', Neighbourhood: 'Vizinhança', Sigma: 'Sigma',
  'Smoothness α²': 'Suavidade α²', Solver: 'Método de solução', Smooth: 'Suavização', Pyramid: 'Pirâmide', Warps: 'Deformações', From: 'De', To: 'Até', Library: 'Biblioteca', Made: 'Hash',
  'Camera timeout': 'Tempo limite da câmera', Delay: 'Atraso', 'Command deadline': 'Tempo limite dos comandos', 'Heartbeat deadline': 'Tempo limite do sinal de atividade',
  'Thermal time': 'Tempo térmico', 'Sense tolerance': 'Tolerância da medida', 'Sense settling': 'Acomodação da medida', 'Sense samples': 'Amostras da medida', Gather: 'Reunião', Before: 'Antes',
  Repeat: 'Repetições', Every: 'Intervalo', Bench: 'Bancada simulada', Saturation: 'Saturação', 'Rise time': 'Tempo de subida', 'Fall time': 'Tempo de descida', 'Least volts': 'Tensão mínima',
  'Most volts': 'Tensão máxima', 'Enable time': 'Tempo de habilitação', 'Enable line': 'Linha de habilitação', Fault: 'Falha', 'Fault after': 'Falha após', 'Freeze after': 'Travamento após',
  'Corrupt one of': 'Um corrompido a cada',
  Neutral: 'Neutro', Table: 'Tabela', 'Max RMS': 'RMS máximo', Sense: 'Medida', 'Sense gain': 'Ganho da medida', 'Sense neutral': 'Neutro da medida', Device: 'Dispositivo', Interface: 'Interface',
  Width: 'Largura', Height: 'Altura', Exposure: 'Exposição', 'White balance': 'Balanço de branco', 'Frames/s': 'Quadros por segundo', Fast: 'Rápido', Port: 'Porta', Baud: 'Baud', Outputs: 'Saídas',
  Event: 'Evento', Frame: 'Quadro', 'Nominal image scale': 'Escala nominal da imagem', 'Source of the image scale': 'Origem da escala da imagem',
  // The planner of the optics.
  Magnification: 'Ampliação', 'Numerical aperture': 'Abertura numérica', 'Image scale, um per px': 'Escala da imagem, µm por px', 'Pixel size': 'Tamanho do pixel', 'Tube factor': 'Fator da lente de tubo', 'Frame rate': 'Taxa de quadros', 'Cells per square millimetre': 'Células por milímetro quadrado', 'Drop radius': 'Raio da gota',
};
